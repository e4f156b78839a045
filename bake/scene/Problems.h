#pragma once
#include "bake/base/Error.h"

#include <string>
#include <vector>

namespace tss {

/// A place in a scene file: JSON pointer and the path of the prim or property.
struct Place {
    std::string pointer;
    std::string path;

    /// A key or an index below this place; the path stays.
    Place operator/(const std::string& key) const;
    Place operator/(std::size_t index) const { return {pointer + "/" + std::to_string(index), path}; }
};

/// Where the readers put what is wrong with a file. Either throws the first problem as InputError, or
/// collects them all, so that the readers go on with a fallback.
class Problems {
public:
    enum class Mode { ThrowFirst, Collect };
    explicit Problems(std::string file, Mode mode = Mode::ThrowFirst) : file_(std::move(file)), mode_(mode) {}

    /// message: what was expected, then what was found.
    void add(const Place& place, const std::string& message);
    /// Something that can be read all the same, but may not be what was meant.
    void warn(const Place& place, const std::string& message);

    bool empty() const { return errors.empty(); }

    std::vector<InputError> errors; ///< at most 1000, the rest is not kept
    std::vector<InputError> warnings;

private:
    std::string file_;
    Mode mode_;
};

} // namespace tss
