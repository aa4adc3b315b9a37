// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vera::detail {

struct PartialFileNote;

/// Throws the std::system_error for a file that cannot be written: its name, what to do, and why.
[[noreturn]] void throw_unwritable(const std::string& name, int error);

/// A new, open file beside a target, which is removed unless it takes the target's place: by the
/// destructor, or by remove_partial_files() when a signal ends the process.
class PartialFile {
public:
    /// The folder is the descriptor of an open one that outlives this object; the shown name is the
    /// target's in messages.
    PartialFile(int folder, std::string target, std::string shown_name);
    ~PartialFile();
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;

    /// -1 when the file is finished.
    int descriptor() const { return descriptor_; }

    /// Closes the file.
    void finish();

    /// Gives the file, which is finished, the target's name, in place of what has it now.
    void take_place();

private:
    int folder_;
    std::string target_;
    std::string shown_name_;
    int descriptor_ = -1;
    PartialFileNote* note_; ///< null once the file is no longer ours to remove
};

} // namespace vera::detail
