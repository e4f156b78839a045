#pragma once
#include "bake/base/Error.h"
#include "bake/scene/Value.h"

#include <concepts>

namespace tss {

/// Texts, and numbers in their shortest form, one after the other: "found ", 3, " of ", 0.5.
template <class... Parts>
std::string joined(const Parts&... parts) {
    std::string text;
    const auto append = [&]<class Part>(const Part& part) {
        if constexpr (std::integral<Part>)
            text += std::to_string(part);
        else if constexpr (std::floating_point<Part>)
            appendNumber(text, part);
        else
            text += part;
    };
    (append(parts), ...);
    return text;
}

/// A place in a scene file: JSON pointer and the path of the prim or property.
struct Place {
    std::string pointer;
    std::string path;

    /// A key or an index below this place; the path stays.
    Place operator/(std::string_view key) const;
    Place operator/(std::size_t index) const { return {pointer + "/" + std::to_string(index), path}; }
    /// A child of the prim of this place, and a property of it.
    Place child(std::size_t index, std::string_view name) const;
    Place property(std::string_view name) const;
};

/// Where the readers put what is wrong with a file. Either throws the first problem as InputError, or
/// collects them all, so that the readers go on with a fallback.
class Problems {
public:
    enum class Mode { ThrowFirst, Collect };
    explicit Problems(std::string file, Mode mode = Mode::ThrowFirst) : file_(std::move(file)), mode_(mode) {}

    /// parts: of the message: what was expected, then what was found.
    template <class... Parts>
    void add(const Place& place, const Parts&... parts) {
        addText(place, joined(parts...));
    }
    /// Something that can be read all the same, but may not be what was meant.
    template <class... Parts>
    void warn(const Place& place, const Parts&... parts) {
        if (warnings.size() < mostKept)
            warnings.emplace_back(Where{file_, place.pointer, place.path}, joined(parts...));
    }

    bool empty() const { return errors.empty(); }

    static constexpr std::size_t mostKept = 1000;
    std::vector<InputError> errors; ///< the first ones, the rest is not kept
    std::vector<InputError> warnings;

private:
    void addText(const Place& place, const std::string& message);

    std::string file_;
    Mode mode_;
};

} // namespace tss
