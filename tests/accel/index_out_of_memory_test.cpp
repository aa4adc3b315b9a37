// SPDX-License-Identifier: Apache-2.0
// What a MeshIndex or a SphereIndex leaves behind when memory runs out while it is made: nothing. A
// program of its own, as it replaces operator new.
#include "vera/accel/mesh_index.h"
#include "vera/accel/sphere_index.h"
#include "vera/base/parallel.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include "sample_mesh.h"
#include "sample_spheres.h"
#include <gtest/gtest.h>

namespace {

constexpr long no_end = -1;

/// How many more times memory is given; without end unless a test says otherwise.
std::atomic<long> times_left = no_end;
/// Blocks of memory that were given and not given back.
std::atomic<long> blocks = 0;

bool may_be_given() {
    long left = times_left.load();
    while (left > 0 && !times_left.compare_exchange_weak(left, left - 1)) {
    }
    return left != 0;
}

/// Nothing where there is none.
void* block_of(std::size_t size, std::size_t alignment) noexcept {
    // aligned_alloc wants whole multiples, and there are no blocks of no bytes.
    const std::size_t whole = (size / alignment + 1) * alignment;
    void* const block = may_be_given() ? std::aligned_alloc(alignment, whole) : nullptr;
    blocks += block != nullptr ? 1 : 0;
    return block;
}

void* block_or_throw(std::size_t size, std::size_t alignment) {
    void* const block = block_of(size, alignment);
    if (block == nullptr)
        throw std::bad_alloc();
    return block;
}

void give_back(void* block) noexcept {
    blocks -= block != nullptr ? 1 : 0;
    std::free(block); // NOLINT
}

constexpr std::size_t usual_alignment = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

} // namespace

// All forms that are used: those that are left out may not call these, under AddressSanitizer.
void* operator new(std::size_t size) {
    return block_or_throw(size, usual_alignment);
}

void* operator new[](std::size_t size) {
    return block_or_throw(size, usual_alignment);
}

void* operator new(std::size_t size, std::align_val_t alignment) {
    return block_or_throw(size, static_cast<std::size_t>(alignment));
}

void* operator new[](std::size_t size, std::align_val_t alignment) {
    return block_or_throw(size, static_cast<std::size_t>(alignment));
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return block_of(size, usual_alignment);
}

void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return block_of(size, usual_alignment);
}

void operator delete(void* block) noexcept {
    give_back(block);
}

void operator delete[](void* block) noexcept {
    give_back(block);
}

void operator delete(void* block, std::size_t) noexcept {
    give_back(block);
}

void operator delete[](void* block, std::size_t) noexcept {
    give_back(block);
}

void operator delete(void* block, std::align_val_t) noexcept {
    give_back(block);
}

void operator delete[](void* block, std::align_val_t) noexcept {
    give_back(block);
}

void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
    give_back(block);
}

void operator delete[](void* block, std::size_t, std::align_val_t) noexcept {
    give_back(block);
}

void operator delete(void* block, const std::nothrow_t&) noexcept {
    give_back(block);
}

void operator delete[](void* block, const std::nothrow_t&) noexcept {
    give_back(block);
}

namespace vera {
namespace {

using testing::random_mesh;
using testing::random_spheres;
using testing::SampleMesh;
using testing::SampleSpheres;

/// Lets memory run out at the first block, and then each time so many blocks later, while make()
/// makes an index.
template <typename Make>
void expect_nothing_left_behind(std::size_t threads, long step, const Make& make) {
    const ThreadLimit limit(threads);
    make(); // what is made once in a process is made
    const long before = blocks;
    long given = 0;
    for (bool made = false; !made; given += step) {
        times_left = given;
        try {
            make();
            made = true;
        } catch (const std::bad_alloc&) { // NOLINT(bugprone-empty-catch)
        }
        times_left = no_end;
        ASSERT_EQ(blocks, before) << "after " << given << " blocks";
    }
    EXPECT_GT(given, 5);
}

/// So many triangles.
void expect_nothing_left_of_mesh(
    std::size_t triangles, MeshIndexQuality quality, std::size_t threads, long step) {
    const SampleMesh mesh = random_mesh(1, triangles);
    expect_nothing_left_behind(
        threads, step, [&] { const MeshIndex index(mesh.spans(), quality); });
}

TEST(MeshIndex, LeavesNothingBehindWhereverMemoryRunsOut) {
    for (const auto quality : {MeshIndexQuality::usual, MeshIndexQuality::high}) {
        expect_nothing_left_of_mesh(1, quality, 1, 1);
        expect_nothing_left_of_mesh(300, quality, 1, 1);
        expect_nothing_left_of_mesh(10'000, quality, 1, 97);
        expect_nothing_left_of_mesh(10'000, quality, 3, 89);
    }
}

TEST(SphereIndex, LeavesNothingBehindWhereverMemoryRunsOut) {
    for (const auto quality : {IndexQuality::usual, IndexQuality::high}) {
        const SampleSpheres spheres = random_spheres(1, 300);
        expect_nothing_left_behind(1, 1, [&] { const SphereIndex index(spheres, quality); });
        expect_nothing_left_behind(3, 7, [&] { const SphereIndex index(spheres, quality); });
    }
}

} // namespace
} // namespace vera
