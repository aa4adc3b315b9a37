// SPDX-License-Identifier: Apache-2.0
#include "scene_fixes.h"

#include "vera/formats/item_place.h"
#include "vera/formats/statement_words.h"
#include "vera/scene/inspection.h"
#include "vera/solids/inner_point.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "missing_light.h"
#include <fmt/format.h>

namespace vera {

namespace {

using Kind = SolidFinding::Kind;

constexpr std::size_t no_statement = ~std::size_t{0};

class FixMaker {
public:
    FixMaker(const Scene& scene, std::string_view text)
        : scene_(scene)
        , text_(text)
        , statements_(statement_words(text))
        , inner_points_(statements_.size(), no_statement) {
        find_inner_points();
    }

    void add(const SolidFinding& finding) {
        if (finding.kind == Kind::duplicate)
            count(remove(finding));
        else if (finding.kind == Kind::turned_face)
            count(turn_round(finding));
        else if (finding.kind == Kind::wrong_inner_point)
            wrong_[{finding.subscene, inner_point_of(finding)}].push_back(finding);
    }

    void add_light(const PointLight& light) {
        const Vec3 at = light.position;
        const std::size_t offset =
            statements_.empty() ? text_.size() : statements_.front().words.front().offset;
        fixes_.edits.push_back(
            {offset,
             0,
             fmt::format(
                 "LI {:.12g} {:.12g} {:.12g}  {:.4g}  1 1 1\n",
                 at.x + 0.0,
                 at.y + 0.0,
                 at.z + 0.0,
                 light.intensity)});
        count(true);
    }

    SceneFixes finish() {
        for (const auto& [place, findings] : wrong_) {
            const bool is_moved =
                place.second != no_statement && move(findings.front(), place.second);
            (is_moved ? fixes_.fixed : fixes_.left) += findings.size();
        }
        fixes_.edits = in_order(std::move(fixes_.edits));
        return std::move(fixes_);
    }

private:
    void count(bool is_fixed) { ++(is_fixed ? fixes_.fixed : fixes_.left); }

    /// Of each statement the IP that holds there, as far as this text tells.
    void find_inner_points() {
        std::map<std::uint32_t, std::size_t> in_section;
        for (std::size_t i = 0; i < statements_.size(); ++i) {
            const StatementWords& words = statements_[i];
            if (words.statement == Statement::inner_point)
                in_section[words.section] = i;
            else if (words.statement == Statement::include)
                in_section.erase(words.section); // it may have another
            const auto found = in_section.find(words.section);
            if (found != in_section.end())
                inner_points_[i] = found->second;
        }
    }

    /// The statement that an item was made of: the only one of its line that makes such a thing,
    /// or, where all have become items, the one in its place.
    std::size_t statement_of(const Geometry& geometry, std::uint32_t number) const {
        const Item& item = geometry.items[number];
        if (item.file != 0)
            return no_statement;
        const auto first = std::lower_bound(
            statements_.begin(),
            statements_.end(),
            item.line,
            [](const StatementWords& words, std::uint64_t line) { return words.line < line; });
        std::vector<std::size_t> able;
        for (auto at = first; at != statements_.end() && at->line == item.line; ++at)
            if (makes(at->statement, item.kind))
                able.push_back(static_cast<std::size_t>(at - statements_.begin()));
        if (able.size() == 1)
            return able.front();
        const auto is_alike = [&](std::size_t i) {
            const Item& other = geometry.items[i];
            return other.file == 0 && other.line == item.line && other.kind == item.kind;
        };
        std::size_t before = 0;
        while (before < number && is_alike(number - before - 1))
            ++before;
        std::size_t behind = 0;
        while (number + behind + 1 < geometry.items.size() && is_alike(number + behind + 1))
            ++behind;
        return before + behind + 1 == able.size() ? able[before] : no_statement;
    }

    std::size_t inner_point_of(const SolidFinding& finding) const {
        const std::size_t statement = statement_of(finding.geometry(scene_), finding.item);
        return statement == no_statement ? no_statement : inner_points_[statement];
    }

    /// Leaves out the statement, with its line where nothing else stands there.
    bool remove(const SolidFinding& finding) {
        const std::size_t statement = statement_of(finding.geometry(scene_), finding.item);
        if (statement == no_statement)
            return false;
        const auto& words = statements_[statement].words;
        std::size_t begin = words.front().offset;
        std::size_t end = words.back().offset + words.back().length;
        const std::size_t blank_begin = text_.substr(0, begin).find_last_not_of(" \t") + 1;
        const std::size_t blank_end = std::min(text_.find_first_not_of(" \t\r", end), text_.size());
        if (blank_end == text_.size() || text_[blank_end] == '\n') {
            const bool begins_line = blank_begin == 0 || text_[blank_begin - 1] == '\n';
            begin = blank_begin;
            end = begins_line ? std::min(blank_end + 1, text_.size()) : end;
        }
        fixes_.edits.push_back({begin, end - begin, ""});
        return true;
    }

    /// Puts each corner in the place of its mirror image; the first stays where it is.
    bool turn_round(const SolidFinding& finding) {
        const std::size_t statement = statement_of(finding.geometry(scene_), finding.item);
        if (statement == no_statement || statements_[statement].statement == Statement::patch)
            return false;
        const auto& words = statements_[statement].words;
        const std::size_t first = statements_[statement].statement == Statement::polygon ? 2 : 1;
        const std::size_t corners = (words.size() - first) / 3;
        for (std::size_t i = 1; i < corners; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const WordSpan& word = words[first + 3 * i + axis];
                const WordSpan& other = words[first + 3 * (corners - i) + axis];
                if (i != corners - i)
                    fixes_.edits.push_back(
                        {word.offset,
                         word.length,
                         std::string(text_.substr(other.offset, other.length))});
            }
        return true;
    }

    /// Moves the IP to where it is right for all faces that it is for.
    bool move(const SolidFinding& finding, std::size_t statement) {
        const Geometry& geometry = finding.geometry(scene_);
        std::vector<std::uint32_t> items;
        for (std::uint32_t i = 0; i < geometry.items.size(); ++i) {
            if (geometry.items[i].outside == Outside::by_normal)
                continue;
            const std::size_t of_item = statement_of(geometry, i);
            if (of_item == no_statement)
                return false; // it may be one of them
            if (inner_points_[of_item] == statement)
                items.push_back(i);
        }
        const auto point = inner_point(geometry, items);
        const auto& words = statements_[statement].words;
        if (!point || words.size() != 4)
            return false;
        for (std::size_t axis = 0; axis < 3; ++axis)
            fixes_.edits.push_back(
                {words[axis + 1].offset,
                 words[axis + 1].length,
                 fmt::format("{}", (*point)[axis] + 0.0)});
        return true;
    }

    const Scene& scene_;
    std::string_view text_;
    std::vector<StatementWords> statements_;
    std::vector<std::size_t> inner_points_;
    /// By geometry and IP.
    std::map<std::pair<std::size_t, std::size_t>, std::vector<SolidFinding>> wrong_;
    SceneFixes fixes_;
};

} // namespace

SceneFixes scene_fixes(
    const PreparedScene& prepared,
    std::span<const SolidFinding> findings,
    std::string_view text,
    const CancelFlag& cancel) {
    FixMaker fixes(prepared.scene, text);
    for (const SolidFinding& finding : findings)
        fixes.add(finding);
    for (const Finding& finding : inspect(prepared.scene, prepared.settings))
        if (finding.kind == Finding::Kind::no_light)
            fixes.add_light(missing_light(prepared, cancel));
    return fixes.finish();
}

} // namespace vera
