// SPDX-License-Identifier: Apache-2.0
// three_svg MESH.obj OUT.svg PIXELS: what three.js' SVGRenderer makes of a mesh, seen along -z by parallel rays, the
// square from (0, 0) to (1, 1). Each triangle has the colour of its number, from 1 on.
//
// The renderer makes elements of a page. There is none: these few lines stand for one, and cost less.
import { readFileSync, writeFileSync } from 'node:fs';
import {
    BufferGeometry, Color, ColorManagement, DoubleSide, Float32BufferAttribute, Mesh, MeshBasicMaterial,
    OrthographicCamera, Scene,
} from 'three';
import { SVGRenderer } from 'three/addons/renderers/SVGRenderer.js';

class Element {
    constructor(name) {
        this.name = name;
        this.attributes = new Map();
        this.childNodes = [];
        this.style = {};
    }

    setAttribute(name, value) {
        this.attributes.set(name, value);
    }

    appendChild(child) {
        this.childNodes.push(child);
    }

    removeChild(child) {
        this.childNodes.splice(this.childNodes.indexOf(child), 1);
    }

    write(texts) {
        texts.push('<', this.name);
        for (const [name, value] of this.attributes)
            texts.push(' ', name, '="', value, '"');
        texts.push('>');
        for (const child of this.childNodes)
            child.write(texts);
        texts.push('</', this.name, '>\n');
    }
}

globalThis.document = { createElementNS: (space, name) => new Element(name) };

function readMesh(path) {
    const corners = [];
    const positions = [];
    for (const line of readFileSync(path, 'utf8').split('\n')) {
        const words = line.split(' ');
        if (words[0] === 'v')
            corners.push(words.slice(1).map(Number));
        else if (words[0] === 'f')
            for (const number of words.slice(1))
                positions.push(...corners[number - 1]);
    }
    return positions;
}

function meshOf(positions) {
    const colors = [];
    for (let number = 1; number <= positions.length / 9; ++number)
        for (let corner = 0; corner < 3; ++corner)
            colors.push((number >> 16) / 255, (number >> 8 & 255) / 255, (number & 255) / 255);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
    geometry.setAttribute('color', new Float32BufferAttribute(colors, 3));
    return new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true, side: DoubleSide }));
}

function cameraFor(positions) {
    let lowest = Infinity;
    let highest = -Infinity;
    for (let i = 2; i < positions.length; i += 3) {
        lowest = Math.min(lowest, positions[i]);
        highest = Math.max(highest, positions[i]);
    }
    const room = 0.01 * (highest - lowest) + 1;
    const camera = new OrthographicCamera(0, 1, 1, 0, room / 2, highest - lowest + 2 * room);
    camera.position.z = highest + room;
    return camera;
}

const [mesh, out, pixels] = process.argv.slice(2);
ColorManagement.enabled = false; // numbers are to come out as they went in
const positions = readMesh(mesh);
const scene = new Scene();
scene.background = new Color(0);
scene.add(meshOf(positions));
const renderer = new SVGRenderer();
renderer.overdraw = 0;
renderer.setPrecision(2);
renderer.setSize(Number(pixels), Number(pixels));
renderer.render(scene, cameraFor(positions));
renderer.domElement.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
const texts = [];
renderer.domElement.write(texts);
writeFileSync(out, texts.join(''));
