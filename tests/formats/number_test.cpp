// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/number.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

using Outcome = ScannedNumber::Outcome;

ScannedNumber scanned(std::string_view text) {
    return scan_number(text.data(), text.data() + text.size());
}

std::size_t length_of(std::string_view text) {
    return static_cast<std::size_t>(scanned(text).end - text.data());
}

/// The number must be the whole text, and have the bits that the C library gives it.
void expect_same_bits(const std::string& text) {
    const ScannedNumber number = scanned(text);
    const double expected = std::strtod(text.c_str(), nullptr);
    ASSERT_EQ(length_of(text), text.size()) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(number.value), std::bit_cast<std::uint64_t>(expected))
        << text;
    ASSERT_EQ(number.outcome, std::isinf(expected) ? Outcome::too_large : Outcome::good) << text;
}

TEST(ScanNumber, ReadsWhatTheLanguagesCallANumber) {
    EXPECT_EQ(scanned("54").value, 54);
    EXPECT_EQ(scanned("54.0").value, 54);
    EXPECT_EQ(scanned("5.").value, 5);
    EXPECT_EQ(scanned(".5").value, 0.5);
    EXPECT_EQ(scanned("+.5").value, 0.5);
    EXPECT_EQ(scanned("-1e-3").value, -0.001);
    EXPECT_EQ(scanned("1E+2").value, 100);
    EXPECT_TRUE(std::signbit(scanned("-0").value));
}

TEST(ScanNumber, ReadsNoFurtherThanTheNumberGoes) {
    EXPECT_EQ(length_of("1.5.5"), 3U);
    EXPECT_EQ(length_of("1e"), 1U);
    EXPECT_EQ(length_of("1e+"), 1U);
    EXPECT_EQ(length_of("1e5e5"), 3U);
    EXPECT_EQ(length_of("12x"), 2U);
    EXPECT_EQ(length_of("0x10"), 1U);
    EXPECT_EQ(length_of("1-1"), 1U);
}

TEST(ScanNumber, FindsNoNumberInOtherWords) {
    for (const char* word :
         {"", "-", "+", ".", "-.", "e5", ".e5", "nan", "inf", "-inf", "--1", "+-1", " 1", "x"}) {
        EXPECT_EQ(scanned(word).outcome, Outcome::not_a_number) << word;
        EXPECT_EQ(length_of(word), 0U) << word;
    }
}

TEST(ScanNumber, SaysWhatIsTooLargeAndRoundsToZeroWhatIsTooSmall) {
    EXPECT_EQ(scanned("1e309").outcome, Outcome::too_large);
    EXPECT_EQ(scanned("-1e99999999999999999999").value, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(scanned("1e-400").outcome, Outcome::good);
    EXPECT_EQ(scanned("1e-400").value, 0);
    EXPECT_EQ(scanned("0e99999").value, 0);
    EXPECT_EQ(scanned(fmt::format("0.{:05001}", 1)).value, 0);
    EXPECT_EQ(scanned(fmt::format("1{:0400}", 0)).outcome, Outcome::too_large);
    EXPECT_EQ(scanned(fmt::format("1{:0400}e-400", 0)).value, 1);
}

TEST(ScanNumber, ReadsEveryShortTextAsFromCharsDoes) {
    constexpr std::string_view letters = "0123456789.-+e \n\r/x";
    std::size_t count = 1;
    for (std::size_t length = 1; length <= 4; ++length) {
        count *= letters.size();
        std::vector<char> text(length);
        for (std::size_t number = 0; number < count; ++number) {
            std::size_t rest = number;
            for (char& letter : text) {
                letter = letters[rest % letters.size()];
                rest /= letters.size();
            }
            const char* const begin = text.data();
            const char* const end = begin + length;
            // from_chars takes no plus.
            const bool plus = text[0] == '+';
            double expected = 0;
            const auto [stop, error] = std::from_chars(begin + (plus ? 1 : 0), end, expected);
            const bool good = error == std::errc{} && !(plus && length > 1 && text[1] == '-');
            const ScannedNumber read = scan_number(begin, end);
            const std::string_view shown(begin, length);
            ASSERT_EQ(read.outcome, good ? Outcome::good : Outcome::not_a_number) << shown;
            ASSERT_EQ(read.end, good ? stop : begin) << shown;
            ASSERT_EQ(
                std::bit_cast<std::uint64_t>(read.value),
                std::bit_cast<std::uint64_t>(good ? expected : 0.0))
                << shown;
        }
    }
}

TEST(ScanNumber, EndsBehindAnyCountOfDigitsAtAnyOtherByte) {
    // More follows, so that eight bytes can be taken at once wherever the number ends.
    const std::string digits = "98765432101234567890123";
    for (std::size_t count = 1; count <= digits.size(); ++count)
        for (int byte = 0; byte < 256; ++byte) {
            const auto letter = static_cast<char>(byte);
            // An exponent would belong to it.
            if ((letter >= '0' && letter <= '9') || letter == 'e' || letter == 'E')
                continue;
            const std::string number = "-3." + digits.substr(0, count);
            const std::string text = number + letter + "1234567812345678";
            const ScannedNumber read = scanned(text);
            ASSERT_EQ(read.end, text.data() + number.size()) << count << " digits, byte " << byte;
            ASSERT_EQ(read.value, std::strtod(number.c_str(), nullptr)) << number;
        }
}

TEST(ScanNumber, RoundsHardCasesAsTheCLibraryDoes) {
    for (const char* text :
         {"9007199254740993",
          "9007199254740992",
          "9007199254740991",
          "900719925474099300000",
          "1.7976931348623157e308",
          "1.7976931348623158e308",
          "1.7976931348623159e308",
          "2.2250738585072014e-308",
          "2.2250738585072011e-308",
          "4.9406564584124654e-324",
          "2.4703282292062327e-324",
          "2.4703282292062328e-324",
          "9223372036854775807",
          "18446744073709551615",
          "18446744073709551616",
          "1844674407370955161.7",
          "9999999999999999999",
          "99999999999999999999",
          "0.000000000000000000000000000000000000001",
          "1e22",
          "1e23",
          "8.5e-23",
          "0.1",
          "0.30000000000000004",
          "00000000000000000000000000000000001.5"})
        expect_same_bits(text);
}

TEST(ScanNumber, ReadsTenThousandDigits) {
    expect_same_bits(fmt::format("{:9>300}.{:9>9700}", "", ""));
    expect_same_bits(fmt::format("0.{:0>300}{:7>9700}", "", ""));
    // Halfway between two doubles, and a digit very far behind that decides.
    expect_same_bits(fmt::format("9007199254740993.{:09981}", 1));
    expect_same_bits(fmt::format("9007199254740993.{:09981}", 0));
}

TEST(ScanNumber, GivesTheBitsOfTheCLibraryForRandomDigits) {
    std::mt19937 random(1988);
    const auto pick = [&](std::size_t count) { return random() % count; };
    for (int round = 0; round < 60'000; ++round) {
        std::string text;
        if (pick(3) == 0)
            text.push_back('-');
        // Few different digits, so that carries and ties are common.
        const char digits[] = {'0', '0', '1', '5', '9', '9', static_cast<char>('0' + pick(10))};
        const std::size_t before = pick(22);
        const std::size_t after = before == 0 ? 1 + pick(22) : pick(22);
        for (std::size_t i = 0; i < before; ++i)
            text += digits[pick(sizeof digits)];
        if (after > 0)
            text += '.';
        for (std::size_t i = 0; i < after; ++i)
            text += digits[pick(sizeof digits)];
        if (pick(2) == 0)
            text += fmt::format("e{}", static_cast<int>(pick(2) == 0 ? pick(60) : pick(700)) - 330);
        expect_same_bits(text);
    }
}

TEST(ScanNumber, GivesBackTheBitsOfRandomDoubles) {
    std::mt19937_64 random(1988);
    for (int round = 0; round < 60'000; ++round) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value))
            continue;
        char text[64];
        const char* const end = std::to_chars(std::begin(text), std::end(text), value).ptr;
        ASSERT_EQ(scan_number(text, end).value, value) << std::string_view(text, end);
        ASSERT_EQ(scan_number(text, end).end, end);
    }
}

} // namespace
} // namespace vera
