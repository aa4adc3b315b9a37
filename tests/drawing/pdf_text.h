// SPDX-License-Identifier: Apache-2.0
// Reads a PDF as a program does that shows it.
#pragma once

#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

namespace vera {

/// The objects of a PDF without their frames, found as a reader finds them: from the end, through
/// the table.
inline std::vector<std::string> objects(const std::string& pdf) {
    std::vector<std::string> found;
    const std::size_t start = pdf.rfind("startxref\n");
    const std::size_t table = std::stoul(pdf.substr(start + 10));
    EXPECT_EQ(pdf.substr(table, 7), "xref\n0 ");
    const std::size_t count = std::stoul(pdf.substr(table + 7));
    const std::size_t first_entry = pdf.find('\n', table + 6) + 1;
    EXPECT_EQ(pdf.substr(first_entry, 20), "0000000000 65535 f \n");
    EXPECT_EQ(pdf.substr(first_entry + 20 * count, 8), "trailer\n");
    EXPECT_THAT(pdf.substr(first_entry), ::testing::HasSubstr(fmt::format("/Size {}/", count)));
    for (std::size_t i = 1; i < count; ++i) {
        const std::string entry = pdf.substr(first_entry + 20 * i, 20);
        EXPECT_EQ(entry.substr(10), " 00000 n \n");
        const std::string begin = fmt::format("{} 0 obj\n", i);
        const std::size_t offset = std::stoul(entry);
        EXPECT_EQ(pdf.substr(offset, begin.size()), begin);
        const std::size_t end = pdf.find("\nendobj\n", offset);
        found.push_back(pdf.substr(offset + begin.size(), end - offset - begin.size()));
    }
    return found;
}

inline std::string inflated(const std::string& object) {
    const std::string before = "/Length ";
    const std::size_t length = std::stoul(object.substr(object.find(before) + before.size()));
    const std::size_t start = object.find("\nstream\n") + 8;
    EXPECT_EQ(object.substr(start + length).substr(0, 10), "\nendstream");

    std::string bytes(1'000'000, '\0');
    uLongf size = bytes.size();
    EXPECT_EQ(
        uncompress(
            reinterpret_cast<Bytef*>(bytes.data()),
            &size,
            reinterpret_cast<const Bytef*>(object.data() + start),
            length),
        Z_OK);
    return bytes.substr(0, size);
}

/// The objects of a PDF whose table is a stream.
inline std::vector<std::string> objects_by_stream(const std::string& pdf) {
    const std::size_t start = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
    const std::string table_object = pdf.substr(start);
    EXPECT_THAT(table_object, ::testing::HasSubstr("/Type/XRef/"));
    EXPECT_THAT(table_object, ::testing::HasSubstr("/W[1 5 5]"));
    const std::string table = inflated(table_object);
    const auto number = [&](std::size_t at, std::size_t bytes) {
        std::size_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i)
            value = value << 8U | static_cast<unsigned char>(table[at + i]);
        return value;
    };
    constexpr std::size_t entry = 11;
    EXPECT_THAT(table_object, ::testing::HasSubstr(fmt::format("/Size {}/", table.size() / entry)));
    const auto object_at = [&](std::size_t offset) { return pdf.substr(offset); };
    std::vector<std::string> found;
    std::string text; // of the packed ones, behind their offsets
    std::size_t texts = 0;
    for (std::size_t i = 1; i < table.size() / entry; ++i) {
        const std::size_t first = number(i * entry + 1, 5);
        if (number(i * entry, 1) == 1) {
            const std::string begin = fmt::format("{} 0 obj\n", i);
            EXPECT_EQ(object_at(first).substr(0, begin.size()), begin);
            const std::size_t end = pdf.find("\nendobj\n", first);
            found.push_back(pdf.substr(first + begin.size(), end - first - begin.size()));
            continue;
        }
        EXPECT_EQ(number(i * entry, 1), 2U);
        if (text.empty()) {
            const std::string holder = object_at(number(first * entry + 1, 5));
            text = inflated(holder);
            texts = std::stoul(holder.substr(holder.find("/First ") + 7));
        }
        std::istringstream offsets(text.substr(0, texts));
        std::size_t own = 0;
        std::size_t offset = 0;
        for (std::size_t k = 0; k <= number(i * entry + 6, 5); ++k)
            offsets >> own >> offset;
        EXPECT_EQ(own, i);
        found.push_back(
            text.substr(texts + offset, text.find('\n', texts + offset) - texts - offset));
    }
    return found;
}

} // namespace vera
