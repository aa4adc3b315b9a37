// SPDX-License-Identifier: Apache-2.0
// envelope_peer MESH.obj OUT.svg PIXELS: the upper envelope of a mesh's triangles by CGAL's
// Envelope_3, seen along -z by parallel rays, the square from (0, 0) to (1, 1). Each triangle has
// the colour of its number, from 1 on.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <CGAL/Env_surface_data_traits_3.h>
#include <CGAL/Env_triangle_traits_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/envelope_3.h>
#include <fmt/format.h>

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Triangles = CGAL::Env_triangle_traits_3<Kernel>;
using Traits = CGAL::Env_surface_data_traits_3<Triangles, std::uint32_t>;
using Diagram = CGAL::Envelope_diagram_2<Traits>;

std::vector<Traits::Surface_3> read_mesh(const char* path) {
    std::ifstream file(path);
    std::vector<Kernel::Point_3> corners;
    std::vector<Traits::Surface_3> triangles;
    std::string word;
    while (file >> word) {
        if (word == "v") {
            double x = 0;
            double y = 0;
            double z = 0;
            file >> x >> y >> z;
            corners.emplace_back(x, y, z);
        } else if (word == "f") {
            std::size_t a = 0;
            std::size_t b = 0;
            std::size_t c = 0;
            file >> a >> b >> c;
            triangles.emplace_back(
                Triangles::Surface_3(corners.at(a - 1), corners.at(b - 1), corners.at(c - 1)),
                static_cast<std::uint32_t>(triangles.size() + 1));
        }
    }
    return triangles;
}

void add_ring(Diagram::Ccb_halfedge_const_circulator first, double pixels, std::string& data) {
    char command = 'M';
    auto edge = first;
    do {
        const auto& point = edge->source()->point();
        data += fmt::format(
            "{}{:.2f} {:.2f}",
            command,
            pixels * CGAL::to_double(point.x()),
            pixels - pixels * CGAL::to_double(point.y()));
        command = 'L';
    } while (++edge != first);
    data += 'Z';
}

void write(const Diagram& diagram, double pixels, const char* path) {
    std::ofstream file(path);
    file << fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {0}\" "
        "fill-rule=\"evenodd\">\n",
        pixels);
    for (auto face = diagram.faces_begin(); face != diagram.faces_end(); ++face) {
        if (face->is_unbounded() || face->number_of_surfaces() == 0)
            continue;
        std::string data;
        add_ring(face->outer_ccb(), pixels, data);
        for (auto hole = face->inner_ccbs_begin(); hole != face->inner_ccbs_end(); ++hole)
            add_ring(*hole, pixels, data);
        file << fmt::format(
            "<path fill=\"#{:06x}\" d=\"{}\"/>\n", face->surfaces_begin()->data(), data);
    }
    file << "</svg>\n";
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: envelope_peer MESH.obj OUT.svg PIXELS\n", stderr);
        return 2;
    }
    const std::vector<Traits::Surface_3> triangles = read_mesh(argv[1]);
    Diagram diagram;
    CGAL::upper_envelope_3(triangles.begin(), triangles.end(), diagram);
    write(diagram, std::atof(argv[3]), argv[2]);
    return 0;
}
