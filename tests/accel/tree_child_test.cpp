// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/tree_child.h"

#include <gtest/gtest.h>

namespace vera::detail {
namespace {

TEST(TreeChild, HoldsWhatItIsAndTheOrdersOfItsPlace) {
    for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{12345}, TreeChild::most - 1})
        for (std::uint64_t kind = 0; kind < 8; ++kind)
            for (std::size_t count = 1; count <= block_width; ++count) {
                TreeChild child = TreeChild::block(first, kind, count);
                for (std::size_t order = 0; order < octant_count; ++order)
                    child.set_order(order, (order + kind) % tree_width);
                EXPECT_EQ(child.is_block(), 1U);
                EXPECT_EQ(child.first(), first);
                EXPECT_EQ(child.kind(), kind);
                EXPECT_EQ(child.count(), count);
                for (std::size_t order = 0; order < octant_count; ++order)
                    EXPECT_EQ(child.in_order(order), (order + kind) % tree_width);
            }
    EXPECT_EQ(TreeChild::node(TreeChild::most - 1).is_block(), 0U);
    EXPECT_EQ(TreeChild::node(TreeChild::most - 1).first(), TreeChild::most - 1);
}

TEST(TreeChild, WaitsInTheOrderOfWhereItsBoxIsEntered) {
    TreeChild child = TreeChild::block(TreeChild::most - 1, 7, block_width);
    child.set_order(octant_count - 1, 7);
    const TreeChild at_once = TreeChild::waiting(child, 0);
    const TreeChild soon = TreeChild::waiting(TreeChild::node(0), 0.001F);
    const TreeChild later = TreeChild::waiting(child, 1.5F);
    EXPECT_LT(at_once.bits, soon.bits);
    EXPECT_LT(soon.bits, later.bits);
    EXPECT_EQ(later.first(), TreeChild::most - 1);
    EXPECT_EQ(later.kind(), 7U);
    EXPECT_EQ(later.count(), block_width);
}

} // namespace
} // namespace vera::detail
