#pragma once
#include "bake/base/Error.h"
#include "bake/scene/Value.h"

#include <string_view>
#include <vector>

namespace tss {

/// The bytes begin as CBOR does (the self-describing tag or a map), not as JSON.
bool looksLikeCbor(std::string_view bytes);

/// Reads one JSON text, UTF-8. Throws LocatedError, with JSON pointer, line and column, for anything that is
/// not strictly JSON (comments, trailing text, a byte order mark, not-finite numbers), and for what JSON
/// allows but a scene file does not: a key twice in one object, more than 64 levels, a NUL byte.
Value parseJson(std::string_view text, const std::string& fileName);

/// Reads one CBOR item (RFC 8949) of the kinds that JSON has: maps with text keys, arrays, text, numbers,
/// true, false, null; definite lengths only. As defensive as parseJson(): every length is checked against the
/// bytes left before anything is kept, text must be UTF-8, numbers finite. Throws InputError with JSON
/// pointer and byte offset.
Value parseCbor(std::string_view bytes, const std::string& fileName);

/// A place in a text; both count from 1, columns in characters. 0: not known, as in a binary file.
struct TextPosition {
    std::size_t line = 0;
    std::size_t column = 0;
};

/// Line and column of a byte of a text; onwards from a position that is known of an earlier one.
TextPosition positionOf(std::string_view text, std::size_t offset, TextPosition position = {1, 1},
                        std::size_t from = 0);

/// An InputError with the line and column of what is wrong.
struct LocatedError : InputError {
    LocatedError(const InputError& error, TextPosition position) : InputError(error), position(position) {}
    TextPosition position;

    /// As what(), with line and column behind the file's name as compilers write them: "jaw.tss:3:14: ...".
    std::string text() const;
};

/// Where the values that JSON pointers name stand in a text, one position a pointer: that of the nearest
/// value around it where there is none (a key that is missing), of the later one where a key stands twice.
/// Reads the text once, up to where it stops being JSON.
std::vector<TextPosition> locateJson(std::string_view text, const std::vector<std::string>& pointers);

} // namespace tss
