#include "bake/usd/UsdaValue.h"

#include "bake/scene/ValueType.h"

#include <charconv>
#include <cmath>
#include <map>

namespace tss {

namespace {

constexpr std::size_t widest = 16; ///< of a tuple in a block
constexpr std::size_t memberSize = sizeof(Value::Object::value_type) + 4 * sizeof(void*);

void checkLevel(UsdaCursor& cursor, int level) {
    if (level > deepestUsda) cursor.refuse("expected at most " + std::to_string(deepestUsda) + " levels");
}

/// Integers that no double holds stay integers.
Value numberValue(UsdaCursor& cursor) {
    std::string_view digits;
    double number = 0;
    if (!cursor.integer(digits)) {
        if (!cursor.number(number)) cursor.refuseFound("a value");
        return Value(number);
    }
    if (digits[0] == '+') digits.remove_prefix(1);
    const char* const end = digits.data() + digits.size();
    std::from_chars(digits.data(), end, number);
    constexpr double exact = 9007199254740992.0;
    std::int64_t small = 0;
    std::uint64_t large = 0;
    if (std::abs(number) < exact) return Value(number);
    if (std::from_chars(digits.data(), end, small).ec == std::errc()) return Value(small);
    if (std::from_chars(digits.data(), end, large).ec == std::errc()) return Value(large);
    return Value(number);
}

/// The values of an array or a tuple, as one block for as long as they are numbers, or tuples of one width.
class Gathered {
public:
    explicit Gathered(UsdaCursor& cursor) : cursor_(cursor) {}

    void add(Value value) {
        const double* number = value.as<double>();
        const Numbers* tuple = value.as<Numbers>();
        const int width = number ? 0
                          : tuple && tuple->width == 0 && tuple->values.size() <= widest
                              ? int(tuple->values.size())
                              : -1;
        if (width >= 0 && values_.empty() && (numbers_.values.empty() || numbers_.width == width)) {
            numbers_.width = width;
            cursor_.spend(sizeof(double) * std::max(width, 1));
            if (number)
                numbers_.values.push_back(*number);
            else
                numbers_.values.insert(numbers_.values.end(), tuple->values.begin(), tuple->values.end());
            return;
        }
        for (std::size_t i = 0; !numbers_.values.empty() && i < numbers_.count(); ++i)
            keep(numbers_.element(i));
        numbers_ = {};
        keep(std::move(value));
    }

    Value take() { return numbers_.values.empty() ? Value(std::move(values_)) : Value(std::move(numbers_)); }

private:
    void keep(Value value) {
        const Numbers* tuple = value.as<Numbers>();
        cursor_.spend(sizeof(Value) + (tuple ? 2 * sizeof(void*) : 0));
        values_.push_back(std::move(value));
    }

    UsdaCursor& cursor_;
    Numbers numbers_;
    Value::Array values_;
};

Value sequence(UsdaCursor& cursor, char open, char close, int level) {
    checkLevel(cursor, level);
    cursor.expect(open);
    Gathered gathered(cursor);
    while (!cursor.take(close)) {
        gathered.add(parseUsdaValue(cursor, level + 1));
        if (!cursor.take(',') && cursor.peek() != close)
            cursor.refuseFound(std::string("\",\" or \"") + close + "\"");
    }
    return gathered.take();
}

/// 0 and 1 as false and true; anything else stays, and is refused by its type.
Value asFlags(const Value& value) {
    const auto flag = [](double number) {
        return number == 0 || number == 1 ? Value(number == 1) : Value(number);
    };
    if (const auto* number = value.as<double>()) return flag(*number);
    if (const auto* numbers = value.as<Numbers>(); numbers && numbers->width == 0) {
        Value::Array flags;
        for (double number : numbers->values) flags.push_back(flag(number));
        return Value(std::move(flags));
    }
    if (const auto* array = value.as<Value::Array>()) {
        Value::Array flags;
        for (const Value& item : *array) flags.push_back(asFlags(item));
        return Value(std::move(flags));
    }
    return value;
}

} // namespace

Value parseUsdaValue(UsdaCursor& cursor, int level) {
    switch (cursor.peek()) {
    case '"':
    case '\'':
        return Value(cursor.string("a text"));
    case '@':
        return Value(cursor.asset());
    case '<':
        return Value(cursor.path());
    case '[':
        return sequence(cursor, '[', ']', level);
    case '(':
        return sequence(cursor, '(', ')', level);
    case '{':
        return Value(parseUsdaDictionary(cursor, level));
    default:
        break;
    }
    if (cursor.takeWord("None")) return {};
    if (cursor.takeWord("true") || cursor.takeWord("True")) return Value(true);
    if (cursor.takeWord("false") || cursor.takeWord("False")) return Value(false);
    return numberValue(cursor);
}

Value parseUsdaValue(UsdaCursor& cursor, const std::string& typeName, int level) {
    const std::size_t line = cursor.line();
    Value value = parseUsdaValue(cursor, level);
    // A path in @@@ may hold @, which those of scene files may not.
    const ValueType* const type =
        valueType(typeName.starts_with("asset") ? "string" + typeName.substr(5) : typeName);
    if (!type) return value;
    if (type->base == ValueType::Base::Bool) {
        if (const auto* flags = value.as<Numbers>()) cursor.spend(sizeof(Value) * flags->values.size());
        value = asFlags(value);
    }
    Problems problems(cursor.file());
    conform(value, *type, {"line " + std::to_string(line), cursor.openPath()}, problems);
    return value;
}

Value::Object parseUsdaDictionary(UsdaCursor& cursor, int level) {
    checkLevel(cursor, level);
    cursor.expect('{');
    Value::Object dictionary;
    while (!cursor.take('}')) {
        std::string type = cursor.word("the type of an entry, or \"}\"", true);
        if (cursor.take('[')) cursor.expect(']'), type += "[]";
        const std::string key = cursor.atString() ? cursor.string("a key") : cursor.word("a key", true);
        cursor.expect('=');
        Value value = type == "dictionary" ? Value(parseUsdaDictionary(cursor, level + 1))
                                           : parseUsdaValue(cursor, type, level + 1);
        cursor.spend(memberSize + key.size());
        if (!dictionary.emplace(key, std::move(value)).second)
            cursor.refuse("expected the key \"" + key + "\" once");
        while (cursor.take(';') || cursor.take(',')) {
        }
    }
    return dictionary;
}

std::string todaysUsdType(const std::string& type) {
    static const std::map<std::string, std::string> names = {
        {"Vec2i", "int2"},         {"Vec3i", "int3"},           {"Vec4i", "int4"},
        {"Vec2h", "half2"},        {"Vec3h", "half3"},          {"Vec4h", "half4"},
        {"Vec2f", "float2"},       {"Vec3f", "float3"},         {"Vec4f", "float4"},
        {"Vec2d", "double2"},      {"Vec3d", "double3"},        {"Vec4d", "double4"},
        {"Quath", "quath"},        {"Quatf", "quatf"},          {"Quatd", "quatd"},
        {"Matrix2d", "matrix2d"},  {"Matrix3d", "matrix3d"},    {"Matrix4d", "matrix4d"},
        {"Transform", "matrix4d"}, {"Frame", "frame4d"},        {"Point", "point3d"},
        {"PointFloat", "point3f"}, {"Normal", "normal3d"},      {"NormalFloat", "normal3f"},
        {"Vector", "vector3d"},    {"VectorFloat", "vector3f"}, {"Color", "color3d"},
        {"ColorFloat", "color3f"}};
    const auto found = names.find(type);
    return found == names.end() ? type : found->second;
}

} // namespace tss
