// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/line_chains.h"

#include <algorithm>
#include <cstddef>

namespace vera {

namespace {

constexpr std::uint32_t no_part = ~std::uint32_t{0};

class Chains {
public:
    Chains(std::span<const LinePart> parts, LineClass line_class, std::size_t point_count)
        : parts_(parts)
        , line_class_(line_class)
        , starts_(point_count + 1)
        , is_done_(parts.size()) {
        const auto for_each_end = [&](const auto& visit) {
            for (std::uint32_t i = 0; i < parts.size(); ++i)
                if (parts[i].line_class == line_class)
                    for (const std::uint32_t vertex : parts[i].ends)
                        visit(vertex, i);
        };
        for_each_end([&](std::uint32_t vertex, std::uint32_t) { ++starts_[vertex + 1]; });
        for (std::size_t i = 1; i < starts_.size(); ++i)
            starts_[i] += starts_[i - 1];
        at_vertex_.resize(starts_.back());
        std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
        for_each_end(
            [&](std::uint32_t vertex, std::uint32_t part) { at_vertex_[next[vertex]++] = part; });
        begin();
    }

    std::size_t count() {
        std::size_t count = 0;
        for_each([&](const LineChain&) { ++count; });
        begin();
        return count;
    }

    /// Open chains from their ends on, then what is left: closed ones.
    template <typename Visit>
    void for_each(const Visit& visit) {
        for (const bool from_ends : {true, false})
            for (std::uint32_t part = 0; part < parts_.size(); ++part)
                for (std::size_t i = 0; i < 2 && is_done_[part] == 0; ++i)
                    if (const std::uint32_t first = parts_[part].ends[i];
                        !from_ends || next_at(first, part) == no_part)
                        visit(followed(part, first));
    }

private:
    /// Of other classes all are done.
    void begin() {
        for (std::size_t i = 0; i < parts_.size(); ++i)
            is_done_[i] = parts_[i].line_class == line_class_ ? 0 : 1;
    }

    std::span<const std::uint32_t> at(std::uint32_t vertex) const {
        return std::span(at_vertex_)
            .subspan(starts_[vertex], starts_[vertex + 1] - starts_[vertex]);
    }

    bool are_one_line(std::uint32_t a, std::uint32_t b) const {
        if (parts_[a].curve != no_curve || parts_[b].curve != no_curve)
            return parts_[a].curve == parts_[b].curve;
        return cross(parts_[a].step, parts_[b].step) == 0;
    }

    /// In which other one the part goes on at the point; the same from either of the two.
    std::uint32_t next_at(std::uint32_t vertex, std::uint32_t part) const {
        const std::span<const std::uint32_t> here = at(vertex);
        if (here.size() == 2)
            return here[0] == part ? here[1] : here[0];
        std::uint32_t found = no_part;
        for (const std::uint32_t other : here)
            if (other != part && are_one_line(part, other)) {
                if (found != no_part)
                    return no_part;
                found = other;
            }
        return found;
    }

    LineChain followed(std::uint32_t part, std::uint32_t begin) {
        LineChain chain = {{begin}, {}, false};
        std::uint32_t here = begin;
        while (true) {
            is_done_[part] = 1;
            chain.parts.push_back(part);
            const auto& ends = parts_[part].ends;
            here = ends[0] == here ? ends[1] : ends[0];
            const std::uint32_t next = next_at(here, part);
            if (here == begin && next == chain.parts.front()) {
                chain.closed = true;
                return chain;
            }
            chain.vertices.push_back(here);
            if (next == no_part || is_done_[next] != 0)
                return chain;
            part = next;
        }
    }

    std::span<const LinePart> parts_;
    LineClass line_class_;
    std::vector<std::uint32_t> starts_;
    std::vector<std::uint32_t> at_vertex_; ///< the parts that end at each point
    std::vector<std::uint8_t> is_done_;
};

} // namespace

void for_each_line_chain(
    std::span<const LinePart> parts,
    LineClass line_class,
    std::size_t point_count,
    const std::function<void(LineChain chain)>& visit,
    const std::function<void(std::size_t count)>& expect) {
    Chains chains(parts, line_class, point_count);
    if (expect)
        expect(chains.count());
    chains.for_each(visit);
}

} // namespace vera
