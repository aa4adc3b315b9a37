// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vera {

/// Values that are overwritten again and again, now more of them and now fewer. A size costs
/// nothing unless there was none as large before, and leaves old values where they are.
template <typename Value>
class Buffer {
public:
    void resize(std::size_t size) {
        if (size > values_.size())
            values_.resize(size);
        size_ = size;
    }

    std::size_t size() const { return size_; }

    Value* data() { return values_.data(); }

    const Value* data() const { return values_.data(); }

    Value* begin() { return data(); }

    Value* end() { return data() + size_; }

    const Value* begin() const { return data(); }

    const Value* end() const { return data() + size_; }

    Value& operator[](std::size_t i) { return values_[i]; }

    const Value& operator[](std::size_t i) const { return values_[i]; }

private:
    std::vector<Value> values_;
    std::size_t size_ = 0;
};

} // namespace vera
