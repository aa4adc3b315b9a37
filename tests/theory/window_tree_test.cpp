// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/whole_below.h"
#include "vera/theory/window_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

bool is_common(PlaceRange a, PlaceRange b) {
    return a.begin < b.end && b.begin < a.end;
}

/// Looks at each.
class PlainSegments {
public:
    bool has_room_for(const WindowSegment& segment) const {
        return std::none_of(all.begin(), all.end(), [&](const WindowSegment& other) {
            return other.across == segment.across && is_common(other.along, segment.along);
        });
    }

    std::vector<WindowSegment> in_window(PlaceRange along, PlaceRange across) const {
        std::vector<WindowSegment> found;
        std::copy_if(
            all.begin(), all.end(), std::back_inserter(found), [&](const WindowSegment& segment) {
                return across.contains(segment.across) && is_common(segment.along, along);
            });
        std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
            return a.across != b.across ? a.across < b.across : a.along.begin < b.along.begin;
        });
        return found;
    }

    std::optional<WindowSegment> last_before(std::int32_t place, std::int32_t across) const {
        std::optional<WindowSegment> last;
        for (const WindowSegment& segment : all)
            if (segment.along.contains(place) && segment.across < across
                && (!last || last->across < segment.across))
                last = segment;
        return last;
    }

    std::vector<WindowSegment> all;
};

PlaceRange any_range(std::int32_t places, std::mt19937_64& random) {
    const std::int32_t begin = whole_below(places, random);
    return {begin, begin + 1 + whole_below(places - begin, random)};
}

TEST(WindowTree, FindsTheSegmentsThatAListFindsWhileTheyComeAndGo) {
    std::mt19937_64 random(1);
    std::size_t found = 0;
    for (const std::int32_t places : {1, 2, 3, 7, 8, 13}) {
        WindowCounts counts;
        WindowTree tree(places, counts);
        PlainSegments plain;
        for (int turn = 0; turn < 4000 && !HasFailure(); ++turn) {
            const std::int32_t number = whole_below(9, random) - 2;
            const WindowSegment segment = {number, any_range(places, random)};
            if (plain.all.size() < 20 && plain.has_room_for(segment)) {
                plain.all.push_back(segment);
                tree.insert(segment);
            } else if (!plain.all.empty()) {
                const std::size_t last = plain.all.size() - 1;
                std::swap(plain.all[random() % plain.all.size()], plain.all[last]);
                tree.remove(plain.all[last]);
                plain.all.pop_back();
            }
            const PlaceRange along = any_range(places, random);
            const std::int32_t low = whole_below(9, random) - 2;
            const PlaceRange across = {low, low + whole_below(5, random)};
            const auto in_window = tree.in_window(along, across);
            EXPECT_TRUE(in_window == plain.in_window(along, across)) << "turn " << turn;
            found += in_window.size();
            const std::int32_t place = whole_below(places, random);
            EXPECT_TRUE(tree.last_before(place, low) == plain.last_before(place, low))
                << "turn " << turn;
        }
        for (const WindowSegment& segment : plain.all)
            tree.remove(segment);
        EXPECT_EQ(tree.entry_count(), 0U);
    }
    EXPECT_GT(found, 20'000U);
}

/// A window with nothing in it takes log^2 n steps, however many segments reach past it.
TEST(WindowTree, PassesByWhatIsInNoWindow) {
    for (const std::int32_t places : {1 << 8, 1 << 12, 1 << 16}) {
        WindowCounts counts;
        WindowTree tree(places, counts);
        for (std::int32_t i = 0; i < 1000; ++i) {
            tree.insert({i, {0, places}});
            tree.insert({i + 2000, {places / 2 - i % 100 - 1, places / 2 + 1}});
        }
        const std::uint64_t before = counts.steps();
        EXPECT_TRUE(tree.in_window({1, places - 1}, {1000, 2000}).empty());
        const double log_n = std::log2(static_cast<double>(tree.entry_count()));
        EXPECT_LT(
            static_cast<double>(counts.steps() - before),
            4 * std::log2(static_cast<double>(places)) * (log_n + 2));
    }
}

TEST(WindowTree, KnowsHowManyEntriesASegmentMayBecome) {
    for (std::int32_t places = 1; places <= 33; ++places) {
        std::size_t most = 0;
        WindowCounts counts;
        WindowTree tree(places, counts);
        for (std::int32_t begin = 0; begin < places; ++begin)
            for (std::int32_t end = begin + 1; end <= places; ++end) {
                tree.insert({0, {begin, end}});
                most = std::max(most, tree.entry_count());
                tree.remove({0, {begin, end}});
            }
        EXPECT_LE(most, tree.most_entries_of_segment()) << places;
        if (std::has_single_bit(static_cast<unsigned>(places))) {
            EXPECT_EQ(most, tree.most_entries_of_segment()) << places;
        }
    }
}

} // namespace
} // namespace vera
