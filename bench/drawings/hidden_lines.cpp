// SPDX-License-Identifier: Apache-2.0
// hidden_lines_peer MESH.obj OUT.svg PIXELS: the visible edges of a mesh by OpenCASCADE's hidden
// line removal for polyhedra, seen along -z by parallel rays, the square from (0, 0) to (1, 1).
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <HLRAlgo_Projector.hxx>
#include <HLRBRep_PolyAlgo.hxx>
#include <HLRBRep_PolyHLRToShape.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <fmt/format.h>
#include <gp_Ax2.hxx>

namespace {

/// Faces that share their edges.
class ShellOfTriangles {
public:
    ShellOfTriangles() { builder_.MakeShell(shell_); }

    void add_corner(const gp_Pnt& point) { corners_.push_back(BRepBuilderAPI_MakeVertex(point)); }

    void add_triangle(const std::array<std::size_t, 3>& corners) {
        BRepBuilderAPI_MakeWire wire;
        for (std::size_t i = 0; i < 3; ++i)
            wire.Add(edge(corners[i], corners[(i + 1) % 3]));
        const BRepBuilderAPI_MakeFace face(wire.Wire(), true);
        if (face.IsDone())
            builder_.Add(shell_, face.Face());
    }

    const TopoDS_Shell& shell() const { return shell_; }

private:
    TopoDS_Edge edge(std::size_t from, std::size_t to) {
        const bool is_reversed = from > to;
        const auto [place, is_new] =
            edges_.try_emplace(std::pair(std::min(from, to), std::max(from, to)));
        if (is_new)
            place->second = BRepBuilderAPI_MakeEdge(
                corners_.at(place->first.first), corners_.at(place->first.second));
        return is_reversed ? TopoDS::Edge(place->second.Reversed()) : place->second;
    }

    BRep_Builder builder_;
    TopoDS_Shell shell_;
    std::vector<TopoDS_Vertex> corners_;
    std::map<std::pair<std::size_t, std::size_t>, TopoDS_Edge> edges_;
};

TopoDS_Shell read_mesh(const char* path) {
    std::ifstream file(path);
    ShellOfTriangles triangles;
    std::string word;
    while (file >> word) {
        if (word == "v") {
            std::array<double, 3> at = {};
            file >> at[0] >> at[1] >> at[2];
            triangles.add_corner({at[0], at[1], at[2]});
        } else if (word == "f") {
            std::array<std::size_t, 3> corners = {};
            for (std::size_t& corner : corners) {
                file >> corner;
                --corner;
            }
            triangles.add_triangle(corners);
        }
    }
    return triangles.shell();
}

void write_edges(const TopoDS_Shape& edges, double pixels, std::ofstream& file) {
    if (edges.IsNull())
        return;
    for (TopExp_Explorer each(edges, TopAbs_EDGE); each.More(); each.Next()) {
        const BRepAdaptor_Curve line(TopoDS::Edge(each.Current()));
        const gp_Pnt from = line.Value(line.FirstParameter());
        const gp_Pnt to = line.Value(line.LastParameter());
        file << fmt::format(
            "<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\"/>\n",
            pixels * from.X(),
            pixels - pixels * from.Y(),
            pixels * to.X(),
            pixels - pixels * to.Y());
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: hidden_lines_peer MESH.obj OUT.svg PIXELS\n", stderr);
        return 2;
    }
    const double pixels = std::atof(argv[3]);
    const TopoDS_Shell shell = read_mesh(argv[1]);
    const BRepMesh_IncrementalMesh triangulated(shell, 0.01);
    const Handle(HLRBRep_PolyAlgo) algorithm = new HLRBRep_PolyAlgo;
    algorithm->Load(shell);
    algorithm->Projector(HLRAlgo_Projector(gp_Ax2({0, 0, 0}, {0, 0, 1}, {1, 0, 0})));
    algorithm->Update();
    HLRBRep_PolyHLRToShape lines;
    lines.Update(algorithm);
    std::ofstream file(argv[2]);
    file << fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {0}\" fill=\"none\" "
        "stroke=\"black\">\n",
        pixels);
    write_edges(lines.VCompound(), pixels, file);
    write_edges(lines.OutLineVCompound(), pixels, file);
    file << "</svg>\n";
    return 0;
}
