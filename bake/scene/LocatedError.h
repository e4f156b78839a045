#pragma once
#include "bake/base/Error.h"

namespace tss {

/// A place in a text; both count from 1, columns in characters. 0: not known, as in a binary file.
struct TextPosition {
    std::size_t line = 0;
    std::size_t column = 0;
};

/// An InputError with the line and column of what is wrong.
struct LocatedError : InputError {
    LocatedError(const InputError& error, TextPosition position) : InputError(error), position(position) {}
    TextPosition position;

    /// As what(), with line and column behind the file's name as compilers write them: "jaw.tss:3:14: ...".
    std::string text() const;
};

} // namespace tss
