// SPDX-License-Identifier: Apache-2.0
// Rectangles that are worst for hulls and for the division of space, and not for the structures of
// the paper.
#include "vera/theory/growth.h"
#include "vera/theory/nested_trees.h"
#include "vera/theory/single_tree.h"

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "theory/index_visits.h"
#include "theory/rectangles.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using Random = std::mt19937_64;
using testing::Rectangles;

std::vector<testing::PlacedRectangle> placed(const Rectangles& rectangles) {
    std::vector<testing::PlacedRectangle> made;
    made.reserve(rectangles.size());
    for (const IsoRectangle& rectangle : rectangles)
        made.push_back(
            {static_cast<double>(rectangle.z),
             static_cast<double>(rectangle.lower_x),
             static_cast<double>(rectangle.upper_x),
             static_cast<double>(rectangle.lower_y),
             static_cast<double>(rectangle.upper_y)});
    return made;
}

std::array<double, 3> values(const std::array<std::int32_t, 3>& of) {
    return {static_cast<double>(of[0]), static_cast<double>(of[1]), static_cast<double>(of[2])};
}

struct Family {
    Rectangles (*rectangles)(std::size_t count, Random& random);
    WholeRay (*ray)(Random& random);
};

/// By the name of the structure.
using Visits = std::map<std::string, double>;
using Growths = std::map<std::string, Growth>;

double steps(const StepCounts& counts) {
    return static_cast<double>(counts.nodes + counts.points);
}

/// What so many rays visit, all together.
Visits visits(const Family& family, std::size_t count, Random& random) {
    const Rectangles rectangles = family.rectangles(count, random);
    const testing::RectangleIndexes indexes(placed(rectangles));
    const NestedTrees nested(rectangles, 8);
    const SingleTree single(rectangles, 8);
    StepCounts of_nested;
    StepCounts of_single;
    Visits sums;
    for (int i = 0; i < 30; ++i) {
        const WholeRay ray = family.ray(random);
        const testing::IndexVisits of_indexes =
            indexes.visits(values(ray.origin), values(ray.direction));
        sums["uniform grid"] += static_cast<double>(of_indexes.uniform_grid);
        sums["tree of grids"] += static_cast<double>(of_indexes.tree_of_grids);
        sums["hierarchy of boxes"] += static_cast<double>(of_indexes.hierarchy_of_boxes);
        const auto expected = brute_force_first_rectangle(rectangles, ray);
        EXPECT_EQ(nested.first_rectangle(ray, &of_nested), expected);
        EXPECT_EQ(single.first_rectangle(ray, &of_single), expected);
    }
    sums["nested trees"] = steps(of_nested);
    sums["single tree"] = steps(of_single);
    return sums;
}

Growths growths(const Family& family) {
    Random random(1988);
    std::vector<double> sizes;
    std::map<std::string, std::vector<double>> counts;
    for (std::size_t count = 128; count <= 2048; count *= 2) {
        sizes.push_back(static_cast<double>(count));
        for (const auto& [name, sum] : visits(family, count, random))
            counts[name].push_back(sum);
    }
    Growths found;
    for (const auto& [name, of] : counts) {
        found[name] = growth(sizes, of);
        ::testing::Test::RecordProperty(
            name,
            std::to_string(of.back() / 30) + " visits, exponent "
                + std::to_string(found[name].exponent));
    }
    return found;
}

bool may_be_linear(const Growth& growth) {
    return growth.exponent + growth.uncertainty > 0.95;
}

bool may_be_within_the_bound(const Growth& growth) {
    return growth.exponent - growth.uncertainty < 0.695;
}

TEST(WorstCases, OfHullsAndOfTheDivisionOfSpaceAreNoneOfNestedTrees) {
    const Growths found =
        growths({testing::rectangles_along_a_diagonal, testing::ray_along_the_diagonal});
    for (const char* name : {"uniform grid", "tree of grids", "hierarchy of boxes"}) {
        EXPECT_TRUE(may_be_linear(found.at(name))) << name;
        EXPECT_FALSE(may_be_within_the_bound(found.at(name))) << name;
    }
    EXPECT_TRUE(may_be_within_the_bound(found.at("nested trees")));
    EXPECT_FALSE(may_be_linear(found.at("nested trees")));
}

TEST(WorstCases, OfTheDivisionOfSpaceIntoEqualCellsAreNoneOfTheOthers) {
    const Growths found = growths({testing::crowd_of_rectangles, testing::ray_in_the_crowd});
    EXPECT_TRUE(may_be_linear(found.at("uniform grid")));
    for (const char* name : {"tree of grids", "hierarchy of boxes", "nested trees"}) {
        EXPECT_TRUE(may_be_within_the_bound(found.at(name))) << name;
        EXPECT_FALSE(may_be_linear(found.at(name))) << name;
    }
}

} // namespace
} // namespace vera
