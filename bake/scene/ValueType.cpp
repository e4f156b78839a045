#include "bake/scene/ValueType.h"

#include "bake/base/NearestFloat.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tss {

namespace {

using Base = ValueType::Base;

ValueType integer(double lowest, double highest) {
    return {Base::Integer, 1, 1, lowest, highest};
}

std::map<std::string, ValueType, std::less<>> makeTypes() {
    std::map<std::string, ValueType, std::less<>> types;
    constexpr double two31 = 2147483648.0, two63 = 9223372036854775808.0;
    types["bool"] = {Base::Bool};
    types["uchar"] = integer(0, 255);
    types["int"] = integer(-two31, two31 - 1);
    types["uint"] = integer(0, 2 * two31 - 1);
    // The largest double below 2^63 and 2^64; integers that no double holds are told apart before.
    types["int64"] = integer(-two63, std::nextafter(two63, 0));
    types["uint64"] = integer(0, std::nextafter(2 * two63, 0));
    types["timecode"] = {Base::Double};
    for (const char* text : {"string", "token", "asset"}) types[text] = {Base::Text};
    const std::pair<char, Base> precisions[] = {{'h', Base::Half}, {'f', Base::Float}, {'d', Base::Double}};
    for (const auto& [letter, base] : precisions) {
        const std::string name = letter == 'h' ? "half" : letter == 'f' ? "float" : "double";
        types[name] = {base};
        for (int n = 2; n <= 4; ++n) types[name + std::to_string(n)] = {base, n};
        for (const char* role : {"point3", "vector3", "normal3", "color3", "texCoord3"})
            types[role + std::string(1, letter)] = {base, 3};
        types[std::string("color4") + letter] = {base, 4};
        types[std::string("texCoord2") + letter] = {base, 2};
        types[std::string("quat") + letter] = {base, 4};
    }
    for (int n = 2; n <= 4; ++n) {
        types["int" + std::to_string(n)] = types["int"];
        types["int" + std::to_string(n)].width = n;
        types["matrix" + std::to_string(n) + "d"] = {Base::Double, n, n};
    }
    types["frame4d"] = {Base::Double, 4, 4};
    std::map<std::string, ValueType, std::less<>> arrays;
    for (auto& [name, type] : types) {
        type.name = name;
        ValueType& array = arrays[name + "[]"] = type;
        array.array = true;
        array.name += "[]";
        array.element = &type;
    }
    types.merge(arrays);
    return types;
}

/// Brings values of one type into the form that they are kept in.
class Conformer {
public:
    Conformer(const ValueType& type, Problems& problems)
        : type_(type), width_(static_cast<std::size_t>(type.width)), problems_(problems) {}

    void conform(Value& value, const Place& place) const {
        if (type_.base == Base::Bool) return checkAll<bool>(value, "true or false", place);
        if (type_.base == Base::Text) {
            checkAll<std::string>(value, "a string", place);
            if (type_.name.starts_with("asset")) checkAssets(value, place);
        } else if (hasBigInteger(value)) {
            return;
        } else if (type_.rows > 1 && type_.array) {
            eachMatrix(value, place);
        } else if (type_.rows > 1) {
            array(value, place);
            const Numbers* rows = value.as<Numbers>();
            if (!rows || rows->count() != std::size_t(type_.rows))
                problems_.add(place, "expected ", type_.rows, " rows (", type_.name, "), found ",
                              describe(value));
        } else if (type_.array) {
            array(value, place);
        } else if (type_.width > 1) {
            Numbers numbers;
            appendTuple(value, place, numbers.values);
            value = Value(std::move(numbers));
        } else {
            value = Value(read(value, [&] { return place; }));
        }
    }

private:
    /// The number as the slot stores it. place: a function, as it is needed for a problem only.
    template <class PlaceOf>
    double stored(double number, const PlaceOf& place) const {
        if (type_.base == Base::Integer) {
            if (number != std::trunc(number) || number < type_.lowest || number > type_.highest)
                problems_.add(place(), "expected ", wantedNumber(), ", found ", describe(Value(number)));
            return number;
        }
        if (!type_.isFloat() || !std::isfinite(number)) return number;
        const double limit = type_.base == Base::Half ? 65504.0 : std::numeric_limits<float>::max();
        // The largest float is mostly written with fewer digits, which are a little more than it is.
        const bool rounds = type_.base == Base::Float && std::abs(number) < 0x1.ffffffp127;
        if (std::abs(number) > limit && !rounds)
            problems_.add(place(), "expected a number of at most ", limit, " in a ",
                          (type_.array ? *type_.element : type_).name, ", found ", describe(Value(number)));
        return nearestFloat(number);
    }

    /// A number, or the word for one that JSON cannot write.
    template <class PlaceOf>
    double read(const Value& value, const PlaceOf& place) const {
        if (const double* number = value.as<double>()) return stored(*number, place);
        if (type_.isReal()) {
            if (const auto* big = value.as<std::int64_t>()) return stored(static_cast<double>(*big), place);
            if (const auto* huge = value.as<std::uint64_t>())
                return stored(static_cast<double>(*huge), place);
            if (const auto* word = value.as<std::string>()) {
                if (*word == "inf") return std::numeric_limits<double>::infinity();
                if (*word == "-inf") return -std::numeric_limits<double>::infinity();
                if (*word == "nan") return std::numeric_limits<double>::quiet_NaN();
            }
        }
        problems_.add(place(), "expected ", wantedNumber(), ", found ", describe(value));
        return 0;
    }

    std::string wantedNumber() const {
        if (type_.base != Base::Integer) return "a number";
        return joined("an integer from ", type_.lowest, " to ", type_.highest);
    }

    std::string wantedTuple() const { return joined("an array of ", width_, " numbers (", type_.name, ")"); }

    void notAnArray(const Value& value, const Place& place) const {
        problems_.add(place, "expected an array (", type_.name, "), found ", describe(value));
    }

    void appendTuple(const Value& value, const Place& place, std::vector<double>& out) const {
        const std::size_t start = out.size();
        const auto here = [&] { return place / (out.size() - start); };
        const auto* numbers = value.as<Numbers>();
        const auto* array = value.as<Value::Array>();
        if (numbers && numbers->width == 0 && numbers->values.size() == width_)
            for (const double number : numbers->values) out.push_back(stored(number, here));
        else if (array && array->size() == width_)
            for (const Value& element : *array) out.push_back(read(element, here));
        else
            problems_.add(place, "expected ", wantedTuple(), ", found ", describe(value));
        out.resize(start + width_);
    }

    /// An array of numbers or of tuples; where it is none it becomes an empty one.
    void array(Value& value, const Place& place) const {
        Numbers* numbers = value.as<Numbers>();
        const auto* array = value.as<Value::Array>();
        Numbers block{{}, type_.width == 1 ? 0 : type_.width};
        if (numbers && numbers->width == block.width) {
            for (std::size_t i = 0; i < numbers->values.size(); ++i)
                numbers->values[i] = stored(numbers->values[i], [&] {
                    return block.width == 0 ? place / i : place / (i / width_) / (i % width_);
                });
            return;
        }
        if (numbers)
            problems_.add(place / 0, "expected ", block.width == 0 ? "a number" : wantedTuple(), ", found ",
                          numbers->width == 0 ? describe(Value(numbers->values[0]))
                                              : joined("an array of ", numbers->width, " elements"));
        else if (!array)
            notAnArray(value, place);
        if (!array || array->empty()) {
            value = Value(Value::Array());
            return;
        }
        block.values.reserve(array->size() * width_);
        for (std::size_t i = 0; i < array->size(); ++i) {
            if (block.width == 0)
                block.values.push_back(read((*array)[i], [&] { return place / i; }));
            else
                appendTuple((*array)[i], place / i, block.values);
        }
        value = Value(std::move(block));
    }

    void eachMatrix(Value& value, const Place& place) const {
        auto* matrices = value.as<Value::Array>();
        if (!matrices) return notAnArray(value, place);
        const Conformer conformer(*type_.element, problems_);
        for (std::size_t i = 0; i < matrices->size(); ++i)
            if (!(*matrices)[i].isNull()) conformer.conform((*matrices)[i], place / i);
    }

    /// The value, or each element of an array, is a T.
    template <class T>
    void checkAll(const Value& value, const char* wanted, const Place& place) const {
        const auto* elements = value.as<Value::Array>();
        if (!type_.array) {
            if (!value.as<T>()) problems_.add(place, "expected ", wanted, ", found ", describe(value));
        } else if (!elements) {
            notAnArray(value, place);
        } else {
            for (std::size_t i = 0; i < elements->size(); ++i)
                if (!(*elements)[i].as<T>())
                    problems_.add(place / i, "expected ", wanted, ", found ", describe((*elements)[i]));
        }
    }

    void checkAssets(const Value& value, const Place& place) const {
        if (const auto* array = value.as<Value::Array>())
            for (std::size_t i = 0; i < array->size(); ++i) checkAssets((*array)[i], place / i);
        const auto* path = value.as<std::string>();
        const auto bad = [](char c) { return c == '@' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
        if (path && std::ranges::any_of(*path, bad))
            problems_.add(place, "expected the path of a file without @ and control characters, found ",
                          describe(value));
    }

    /// An integer that a double cannot hold, or an array with one, stays as it is.
    bool hasBigInteger(const Value& value) const {
        if (type_.base != Base::Integer || type_.highest < 4294967296.0) return false;
        const auto* array = value.as<Value::Array>();
        if (array) return std::ranges::any_of(*array, [&](const Value& v) { return isBigInteger(v); });
        return isBigInteger(value);
    }
    bool isBigInteger(const Value& value) const {
        return value.as<std::int64_t>() || (type_.lowest == 0 && value.as<std::uint64_t>());
    }

    const ValueType& type_;
    std::size_t width_;
    Problems& problems_;
};

} // namespace

const ValueType* valueType(std::string_view typeName) {
    static const auto types = makeTypes();
    const auto found = types.find(typeName);
    return found == types.end() ? nullptr : &found->second;
}

void conform(Value& value, const ValueType& type, const Place& place, Problems& problems) {
    if (!value.isNull()) Conformer(type, problems).conform(value, place);
}

} // namespace tss
