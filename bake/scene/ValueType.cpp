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
    return {Base::Integer, 1, 1, false, lowest, highest};
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
    return types;
}

/// Checks the single numbers of one value.
class NumberCheck {
public:
    NumberCheck(const ValueType& type, std::string_view typeName, Problems& problems)
        : type_(type), name_(typeName.substr(0, typeName.find('['))), problems_(problems) {}

    /// The number as the slot stores it. place: a function, as it is needed for a problem only.
    template <class PlaceOf>
    double stored(double number, const PlaceOf& place) const {
        if (type_.base == Base::Integer) {
            if (number != std::trunc(number) || number < type_.lowest || number > type_.highest)
                problems_.add(place(), "expected ", integerText(), ", found ", describe(Value(number)));
            return number;
        }
        if (!type_.isFloat() || !std::isfinite(number)) return number;
        const double limit = type_.base == Base::Half ? 65504.0 : std::numeric_limits<float>::max();
        // The largest float is mostly written with fewer digits, which are a little more than it is.
        const bool rounds = type_.base == Base::Float && std::abs(number) < 0x1.ffffffp127;
        if (std::abs(number) > limit && !rounds)
            problems_.add(place(), "expected a number of at most ", limit, " in a ", name_, ", found ",
                          describe(Value(number)));
        return nearestFloat(number);
    }

    /// A number, or the word for one that JSON cannot write.
    template <class PlaceOf>
    double read(const Value& value, const PlaceOf& place) const {
        if (const double* number = value.as<double>()) return stored(*number, place);
        if (const auto* big = value.as<std::int64_t>(); big && type_.isReal())
            return stored(static_cast<double>(*big), place);
        if (const auto* huge = value.as<std::uint64_t>(); huge && type_.isReal())
            return stored(static_cast<double>(*huge), place);
        const std::string* word = value.as<std::string>();
        if (word && type_.isReal()) {
            if (*word == "inf") return std::numeric_limits<double>::infinity();
            if (*word == "-inf") return -std::numeric_limits<double>::infinity();
            if (*word == "nan") return std::numeric_limits<double>::quiet_NaN();
        }
        problems_.add(place(), "expected ", type_.base == Base::Integer ? integerText() : "a number",
                      ", found ", describe(value));
        return 0;
    }

    std::string integerText() const {
        return joined("an integer from ", type_.lowest, " to ", type_.highest);
    }

private:
    const ValueType& type_;
    std::string_view name_;
    Problems& problems_;
};

std::string tupleText(int width, std::string_view typeName) {
    return joined("an array of ", width, " numbers (", typeName, ")");
}

void notAnArray(const Value& value, std::string_view typeName, const Place& place, Problems& problems) {
    problems.add(place, "expected an array (", typeName, "), found ", describe(value));
}

/// One tuple of `width` numbers appended to `out`; `out` always grows by width.
void appendTuple(const Value& value, int width, const NumberCheck& check, std::string_view typeName,
                 const Place& place, Problems& problems, std::vector<double>& out) {
    const std::size_t start = out.size();
    if (const Numbers* numbers = value.as<Numbers>(); numbers && numbers->width == 0) {
        if (numbers->values.size() == std::size_t(width))
            for (double number : numbers->values)
                out.push_back(check.stored(number, [&] { return place / (out.size() - start); }));
        else
            problems.add(place, "expected ", tupleText(width, typeName), ", found ", describe(value));
    } else if (const auto* array = value.as<Value::Array>(); array && array->size() == std::size_t(width)) {
        for (const Value& element : *array)
            out.push_back(check.read(element, [&] { return place / (out.size() - start); }));
    } else {
        problems.add(place, "expected ", tupleText(width, typeName), ", found ", describe(value));
    }
    out.resize(start + width);
}

/// An array of numbers, or of tuples, whatever form the parser found for it.
void conformArray(Value& value, int width, const NumberCheck& check, std::string_view typeName,
                  const Place& place, Problems& problems) {
    if (Numbers* numbers = value.as<Numbers>(); numbers && numbers->width == (width == 1 ? 0 : width)) {
        for (std::size_t i = 0; i < numbers->values.size(); ++i)
            numbers->values[i] = check.stored(numbers->values[i], [&] {
                return width == 1 ? place / i : place / (i / width) / (i % width);
            });
        return;
    }
    if (const Numbers* numbers = value.as<Numbers>()) {
        const bool flat = numbers->width == 0;
        problems.add(place / 0, "expected ", width == 1 ? "a number" : tupleText(width, typeName), ", found ",
                     flat ? describe(Value(numbers->values[0]))
                          : joined("an array of ", numbers->width, " elements"));
        value = Value(Value::Array());
        return;
    }
    const auto* array = value.as<Value::Array>();
    if (!array) {
        notAnArray(value, typeName, place, problems);
        value = Value(Value::Array());
        return;
    }
    if (array->empty()) return;
    Numbers block{{}, width == 1 ? 0 : width};
    block.values.reserve(array->size() * width);
    for (std::size_t i = 0; i < array->size(); ++i) {
        if (width == 1)
            block.values.push_back(check.read((*array)[i], [&] { return place / i; }));
        else
            appendTuple((*array)[i], width, check, typeName, place / i, problems, block.values);
    }
    value = Value(std::move(block));
}

template <class T>
void conformEach(Value& value, bool array, const char* wanted, std::string_view typeName, const Place& place,
                 Problems& problems) {
    const auto check = [&](const Value& element, const Place& at) {
        if (!element.as<T>()) problems.add(at, "expected ", wanted, ", found ", describe(element));
    };
    if (!array) return check(value, place);
    if (const auto* elements = value.as<Value::Array>()) {
        for (std::size_t i = 0; i < elements->size(); ++i)
            if (!(*elements)[i].as<T>()) check((*elements)[i], place / i);
    } else {
        notAnArray(value, typeName, place, problems);
    }
}

/// The path of a file, which .usda writes between @.
void checkAssets(const Value& value, const Place& place, Problems& problems) {
    if (const auto* array = value.as<Value::Array>())
        for (std::size_t i = 0; i < array->size(); ++i) checkAssets((*array)[i], place / i, problems);
    const auto* path = value.as<std::string>();
    const auto bad = [](char c) { return c == '@' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
    if (path && std::ranges::any_of(*path, bad))
        problems.add(place, "expected the path of a file without @ and control characters, found ",
                     describe(value));
}

/// Integers of 64 bits that no double holds stay as they are, in a plain array.
bool isBigInteger(const Value& value, const ValueType& type) {
    if (type.base != Base::Integer || type.highest < 4294967296.0) return false;
    return value.as<std::int64_t>() || (type.lowest == 0 && value.as<std::uint64_t>());
}

bool hasBigInteger(const Value& value, const ValueType& type) {
    const auto* array = value.as<Value::Array>();
    if (!array) return isBigInteger(value, type);
    for (const Value& element : *array)
        if (isBigInteger(element, type)) return true;
    return false;
}

} // namespace

std::optional<ValueType> valueType(std::string_view typeName) {
    static const auto types = makeTypes();
    const bool array = typeName.ends_with("[]");
    const auto found = types.find(array ? typeName.substr(0, typeName.size() - 2) : typeName);
    if (found == types.end()) return std::nullopt;
    ValueType type = found->second;
    type.array = array;
    return type;
}

void conform(Value& value, const ValueType& type, std::string_view typeName, const Place& place,
             Problems& problems) {
    if (value.isNull()) return;
    if (type.base == Base::Bool)
        return conformEach<bool>(value, type.array, "true or false", typeName, place, problems);
    if (type.base == Base::Text) {
        conformEach<std::string>(value, type.array, "a string", typeName, place, problems);
        if (typeName.starts_with("asset")) checkAssets(value, place, problems);
        return;
    }
    if (hasBigInteger(value, type)) return;

    const NumberCheck check(type, typeName, problems);
    if (type.rows > 1 && type.array) {
        auto* matrices = value.as<Value::Array>();
        if (!matrices)
            notAnArray(value, typeName, place, problems);
        else
            for (std::size_t i = 0; i < matrices->size(); ++i) {
                ValueType one = type;
                one.array = false;
                conform((*matrices)[i], one, typeName.substr(0, typeName.size() - 2), place / i, problems);
            }
    } else if (type.rows > 1) {
        conformArray(value, type.width, check, typeName, place, problems);
        const Numbers* rows = value.as<Numbers>();
        if (!rows || rows->count() != std::size_t(type.rows))
            problems.add(place, "expected ", type.rows, " rows (", typeName, "), found ", describe(value));
    } else if (type.array) {
        conformArray(value, type.width, check, typeName, place, problems);
    } else if (type.width > 1) {
        Numbers tuple;
        appendTuple(value, type.width, check, typeName, place, problems, tuple.values);
        value = Value(std::move(tuple));
    } else {
        value = Value(check.read(value, [&] { return place; }));
    }
}

} // namespace tss
