#include "bake/scene/Problems.h"

namespace tss {

Place Place::operator/(std::string_view key) const {
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

Place Place::child(std::size_t index, std::string_view name) const {
    Place place = *this / "primChildren" / index;
    place.path.append("/").append(name);
    return place;
}

Place Place::property(std::string_view name) const {
    Place place = *this / "properties" / name;
    place.path.append(".").append(name);
    return place;
}

void Problems::addText(const Place& place, const std::string& message) {
    InputError error({file_, place.pointer, place.path}, message);
    if (mode_ == Mode::ThrowFirst) throw error;
    if (errors.size() < mostKept) errors.push_back(std::move(error));
}

} // namespace tss
