// SPDX-License-Identifier: Apache-2.0
// The diagrams of the paper's section 3 and appendix, and of what goes beyond it, drawn from the
// structures themselves: what is seen in them is what was computed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace vera {

/// A number that a figure's caption states.
struct FigureCount {
    std::string what;
    std::size_t count = 0;
};

/// A figure, and what its caption counts.
struct DrawnFigure {
    std::string svg;
    std::vector<FigureCount> counts;

    /// Of that name, which there must be.
    std::size_t count(const std::string& what) const;
};

struct Figure {
    std::string name;  ///< as in the paper: "3b"; those beyond it begin with B
    std::string title; ///< for people
    DrawnFigure (*drawn)();
};

/// All there are, in the paper's order.
std::span<const Figure> figures();

// Each is the same from run to run and on every machine.
DrawnFigure figure_of_cube();             // 3a
DrawnFigure figure_of_conjugation_tree(); // 3b
DrawnFigure figure_of_dual_space();       // 3c
DrawnFigure figure_of_segment_tree();     // 3d
DrawnFigure figure_of_connection_graph(); // A1
DrawnFigure figure_of_traversal();        // A2
DrawnFigure figure_of_windows();          // B1

} // namespace vera
