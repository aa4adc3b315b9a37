// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/text_cursor.h"

namespace vera {

/// Reads a line of an OBJ or MTL file, and goes behind it: a statement, by read_statement(), with
/// what continues it, or a comment.
template <typename ReadStatement>
void read_statement_line(TextCursor& cursor, const ReadStatement& read_statement) {
    cursor.skip_blanks();
    // Not even a backslash at its end continues a comment: "# from C:\\models\\".
    if (cursor.peek() == '#')
        return cursor.skip_comment();
    read_statement();
    cursor.skip_line();
}

} // namespace vera
