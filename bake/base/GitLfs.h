#pragma once
#include "bake/base/Error.h"

#include <string_view>

namespace tss {

/// Git LFS keeps a short text in place of each large file that has not been fetched. Throws InputError where
/// a file begins like one.
inline void expectFetched(const std::string& file, std::string_view begin) {
    if (begin.starts_with("version https://git-lfs.github.com/spec/"))
        throw InputError(Where{file},
                         "is a pointer of Git LFS; expected the file that it stands for: git lfs pull");
}

} // namespace tss
