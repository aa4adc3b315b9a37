// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/number.h"

#include <charconv>
#include <initializer_list>
#include <iterator>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace vera {
namespace {

using Outcome = ScannedNumber::Outcome;

ScannedNumber scanned(const std::string& text) {
    return scan_number(text.data(), text.data() + text.size());
}

TEST(ScanNumber, ReadsWhatTheLanguageCallsANumber) {
    for (const auto& [text, value] : std::initializer_list<std::pair<const char*, double>>{
             {"54", 54},
             {"54.0", 54},
             {".5", 0.5},
             {"5.", 5},
             {"-1e-3", -0.001},
             {"+7E+2", 700},
             {"000.10", 0.1},
             {"9007199254740993", 9007199254740992},
             {"123456789012345678901234567890", 123456789012345678901234567890.0}}) {
        EXPECT_EQ(scanned(text).outcome, Outcome::good) << text;
        EXPECT_EQ(scanned(text).value, value) << text;
    }
}

TEST(ScanNumber, StopsBehindTheNumber) {
    const std::string text = "1e+ 2";
    EXPECT_EQ(scanned(text).value, 1);
    EXPECT_EQ(scanned(text).end, text.data() + 1);
}

TEST(ScanNumber, TakesNoOtherWordForANumber) {
    for (const char* text : {"", "-", ".", "+.", "e5", ".e5", "nan", "inf", "-inf", "O"})
        EXPECT_EQ(scanned(text).outcome, Outcome::not_a_number) << text;
}

TEST(ScanNumber, SaysOfANumberOfAnyLengthOnWhichSideItIsOutOfRange) {
    const std::string many_digits(20'000, '1');
    EXPECT_EQ(scanned(many_digits + "e-19000").outcome, Outcome::too_large);
    EXPECT_EQ(scanned(many_digits + "e-30000").outcome, Outcome::good);
    EXPECT_EQ(scanned(many_digits + "e-30000").value, 0);
    EXPECT_EQ(scanned("1" + std::string(20'000, '0') + "e-20000").value, 1);
    EXPECT_EQ(scanned("0." + std::string(20'000, '0') + "1e20001").value, 1);
    EXPECT_EQ(scanned("1e99999999999999999999999").outcome, Outcome::too_large);
    EXPECT_EQ(scanned("-1e-99999999999999999999999").value, 0);
}

TEST(ScanNumber, GivesTheBitsThatTheStandardLibraryGives) {
    std::mt19937 random(1988);
    const std::string pieces[] = {"0", "1", "9", "5", "00", "999", ".", "e", "-", "17"};
    for (int round = 0; round < 20'000; ++round) {
        std::string text;
        for (auto count = random() % 8 + 1; count > 0; --count)
            text += pieces[random() % std::size(pieces)];
        const ScannedNumber number = scanned(text);
        double expected = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), expected);
        if (error == std::errc::invalid_argument) {
            ASSERT_EQ(number.outcome, Outcome::not_a_number) << text;
        } else {
            ASSERT_EQ(number.end, end) << text;
            if (error == std::errc{}) {
                ASSERT_EQ(number.value, expected) << text;
            }
        }
    }
}

} // namespace
} // namespace vera
