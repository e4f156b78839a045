#pragma once
#include "bake/scene/Value.h"

#include <string_view>

namespace tss {

/// The bytes begin as CBOR does (the self-describing tag or a map), not as JSON.
bool looksLikeCbor(std::string_view bytes);

/// Reads one CBOR item (RFC 8949) of the kinds that JSON has: maps with text keys, arrays, text, numbers,
/// true, false, null; definite lengths only. As defensive as parseJson(): every length is checked against the
/// bytes left before anything is kept, text must be UTF-8, numbers finite. Throws InputError with JSON
/// pointer and byte offset.
Value parseCbor(std::string_view bytes, const std::string& fileName);

} // namespace tss
