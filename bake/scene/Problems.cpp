#include "bake/scene/Problems.h"

namespace tss {

namespace {
constexpr std::size_t mostKept = 1000;
}

Place Place::operator/(const std::string& key) const {
    Place place{pointer + "/", path};
    for (char c : key) { // RFC 6901
        if (c == '~')
            place.pointer += "~0";
        else if (c == '/')
            place.pointer += "~1";
        else
            place.pointer += c;
    }
    return place;
}

void Problems::add(const Place& place, const std::string& message) {
    InputError error({file_, place.pointer, place.path}, message);
    if (mode_ == Mode::ThrowFirst) throw error;
    if (errors.size() < mostKept) errors.push_back(std::move(error));
}

void Problems::warn(const Place& place, const std::string& message) {
    if (warnings.size() < mostKept) warnings.emplace_back(Where{file_, place.pointer, place.path}, message);
}

} // namespace tss
