// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/statement_words.h"

#include <algorithm>

namespace vera {

namespace {

/// Reads word after word: white space and comments part them, and quotes hold one together.
class Words {
public:
    explicit Words(std::string_view text)
        : text_(text) {}

    /// False at the end of the text.
    bool next(WordSpan& word) {
        skip();
        if (at_ >= text_.size())
            return false;
        word.offset = at_;
        if (text_[at_] == '"')
            at_ = std::min(text_.find('"', at_ + 1), text_.size() - 1) + 1;
        else
            while (at_ < text_.size() && !is_space(text_[at_]) && !begins_comment())
                ++at_;
        word.length = at_ - word.offset;
        return true;
    }

    std::uint64_t line() const { return line_; }

private:
    static bool is_space(char letter) {
        return letter == ' ' || letter == '\t' || letter == '\r' || letter == '\n';
    }

    bool begins_comment() const { return text_.substr(at_, 2) == "(*"; }

    void skip() {
        while (at_ < text_.size()) {
            if (begins_comment()) {
                const std::size_t end = std::min(text_.find("*)", at_ + 2), text_.size() - 2) + 2;
                line_ += static_cast<std::uint64_t>(
                    std::ranges::count(text_.substr(at_, end - at_), '\n'));
                at_ = end;
            } else if (is_space(text_[at_])) {
                line_ += text_[at_++] == '\n' ? 1 : 0;
            } else {
                return;
            }
        }
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 1;
};

bool ends_subscene(Statement statement) {
    return statement == Statement::material || statement == Statement::light
        || statement == Statement::projection || statement == Statement::parallel;
}

} // namespace

std::vector<StatementWords> statement_words(std::string_view text) {
    std::vector<StatementWords> statements;
    Words words(text);
    std::uint32_t section = 0;
    std::uint32_t last_section = 0;
    for (WordSpan word; words.next(word);) {
        const auto statement = statement_named(text.substr(word.offset, word.length));
        if (statement) {
            if (*statement == Statement::subscene)
                section = ++last_section;
            else if (ends_subscene(*statement))
                section = 0;
            statements.push_back({*statement, words.line(), section, {}});
        }
        if (!statements.empty())
            statements.back().words.push_back(word);
    }
    return statements;
}

} // namespace vera
