// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/box_tree.h"

#include "vera/accel/box_tree_cuts.h"
#include "vera/accel/box_tree_nodes.h"
#include "vera/accel/box_tree_reinsertion.h"
#include "vera/base/check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

namespace vera::detail {

namespace {

/// Nodes that stay where they are while others are added.
class Nodes {
public:
    BinaryNode& add() {
        if (used_of_last_ == block_size) {
            blocks_.push_back(std::make_unique<Block>());
            used_of_last_ = 0;
        }
        return (*blocks_.back())[used_of_last_++];
    }

    const BinaryNode& front() const { return blocks_.front()->front(); }

    /// Calls turn(node) for each, the last that was added first.
    template <typename Turn>
    void for_each_backwards(const Turn& turn) {
        std::size_t used = used_of_last_;
        for (std::size_t i = blocks_.size(); i-- > 0; used = block_size)
            for (std::size_t j = used; j-- > 0;)
                turn((*blocks_[i])[j]);
    }

private:
    static constexpr std::size_t block_size = 64;
    using Block = std::array<BinaryNode, block_size>;

    std::vector<std::unique_ptr<Block>> blocks_;
    std::size_t used_of_last_ = block_size;
};

/// A part of the tree that is cut up later, on any thread.
struct Deferred {
    ReferenceRange range;
    std::size_t depth = 0;
    BinaryNode* root = nullptr;
};

void fill_costs_below(BinaryNode& node) {
    if (!node.is_leaf())
        for (BinaryNode* child : node.children)
            fill_costs_below(*child);
    fill_costs(node);
}

class Builder {
public:
    Builder(
        std::vector<BoxReference>& references,
        std::size_t leaf_size,
        const CancelFlag* cancel,
        std::span<const float> contents)
        : references_(references)
        , leaf_size_(leaf_size)
        , cancel_(cancel)
        , contents_(contents) {}

    void build(TreeEffort effort) {
        // About so many subtrees for the threads, their number not depending on that of the
        // threads: the tree is always the same.
        constexpr std::size_t subtrees = 64;
        constexpr std::size_t least = 2048;
        const std::size_t subtree_size = std::max(least, references_.size() / subtrees);
        std::vector<Deferred> deferred;
        BinaryNode& root = top_.add();
        const ReferenceRange all = range_of(references_, 0, references_.size());
        grow(root, all, 0, {top_, subtree_size, &deferred});
        below_.resize(deferred.size());
        parallel_ranges(deferred.size(), 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const Deferred& part = deferred[i];
                grow(*part.root, part.range, part.depth, {below_[i]});
                if (effort == TreeEffort::high)
                    reinsert_nodes(*part.root, 1, cancel_);
            }
        });
        // Children stand behind their parents.
        top_.for_each_backwards([](BinaryNode& node) {
            if (!node.is_leaf())
                finish(node);
        });
        if (effort == TreeEffort::high) {
            // What is large may belong into another subtree.
            constexpr double largest = 0.05;
            reinsert_nodes(root, largest, cancel_);
            fill_costs_below(root);
        }
    }

    const BinaryNode& root() const { return top_.front(); }

private:
    /// Where a part of the tree is put.
    struct Part {
        Nodes& nodes;
        std::size_t deferred_size = 0; ///< so few references are deferred
        std::vector<Deferred>* deferred = nullptr;
    };

    std::span<const BoxReference> references_of(const ReferenceRange& range) const {
        return std::span<const BoxReference>(references_).subspan(range.first, range.size());
    }

    float content_of(const BoxReference& reference) const {
        return contents_.empty() ? surface(reference.box()) : contents_[reference.element];
    }

    /// Whether the range makes a leaf as it is.
    bool is_leaf(const ReferenceRange& range) const {
        const auto references = references_of(range);
        return range.size() <= leaf_size_
            && std::all_of(
                   references.begin(), references.end(), [&](const BoxReference& reference) {
                       return reference.kind == references.front().kind;
                   });
    }

    Halves cut_at(const ReferenceRange& range, std::size_t middle) const {
        return {
            range_of(references_, range.first, middle), range_of(references_, middle, range.last)};
    }

    /// Cuts the range, which is no leaf, in two that are not empty.
    Halves halves(const ReferenceRange& range, std::size_t depth) {
        if (range.size() <= leaf_size_) {
            const auto begin = references_.begin() + static_cast<std::ptrdiff_t>(range.first);
            const auto end = references_.begin() + static_cast<std::ptrdiff_t>(range.last);
            const std::uint32_t kind = begin->kind;
            const auto middle = std::partition(
                begin, end, [&](const BoxReference& reference) { return reference.kind == kind; });
            return cut_at(range, static_cast<std::size_t>(middle - references_.begin()));
        }
        // Where cuts by surface have led so deep, only halving keeps below the last level.
        constexpr std::size_t last_level = most_tree_levels - 2 * tree_width;
        if (depth + static_cast<std::size_t>(std::bit_width(range.size())) < last_level)
            if (const auto found = halves_by_surface(references_, range))
                return *found;
        return cut_at(range, range.first + range.size() / 2);
    }

    /// Makes the node of a range, so many levels below the root, and what is below it.
    void grow(BinaryNode& node, const ReferenceRange& range, std::size_t depth, const Part& part) {
        if (cancel_ != nullptr)
            cancel_->throw_if_raised();
        if (range.size() <= part.deferred_size) {
            part.deferred->push_back({range, depth, &node});
            return;
        }
        node.box = range.box.box();
        if (is_leaf(range)) {
            node.first = static_cast<std::uint32_t>(range.first);
            node.size = static_cast<std::uint32_t>(range.size());
            for (const BoxReference& reference : references_of(range))
                node.content += content_of(reference);
            fill_costs(node);
            return;
        }
        const auto [left, right] = halves(range, depth);
        for (BinaryNode*& child : node.children) {
            child = &part.nodes.add();
            child->parent = &node;
        }
        grow(*node.children[0], left, depth + 1, part);
        grow(*node.children[1], right, depth + 1, part);
        if (part.deferred == nullptr)
            finish(node);
    }

    /// What follows from the node's children.
    static void finish(BinaryNode& node) {
        join_children(node);
        fill_costs(node);
    }

    std::vector<BoxReference>& references_;
    std::size_t leaf_size_;
    const CancelFlag* cancel_;
    std::span<const float> contents_;
    Nodes top_; ///< the first is the root
    std::vector<Nodes> below_;
};

} // namespace

BoxTree build_box_tree(
    std::vector<BoxReference> references,
    std::size_t leaf_size,
    const CancelFlag* cancel,
    TreeEffort effort,
    std::span<const float> contents) {
    VERA_CHECK(leaf_size >= 1 && leaf_size <= tree_width);
    // There are no more nodes than references: each but the root has at least two children.
    if (references.size() > TreeChild::most)
        throw std::length_error("more references than a tree of boxes can number");
    BoxTree tree;
    tree.references = std::move(references);
    if (!tree.references.empty()) {
        Builder builder(tree.references, leaf_size, cancel, contents);
        builder.build(effort);
        make_wide_nodes(builder.root(), tree);
    }
    return tree;
}

} // namespace vera::detail
