#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tss {

struct Value;

/// 2^53: up to here a double holds every integer.
constexpr double exactIntegers = 9007199254740992.0;

/// Many numbers in one block: an array of numbers (width 0), or an array of tuples of `width` numbers each.
/// Never empty; each is a double, or an integer that a double holds exactly.
struct Numbers {
    std::vector<double> values;
    int width = 0;

    std::size_t count() const { return width == 0 ? values.size() : values.size() / width; }
    Value element(std::size_t index) const;
    friend bool operator==(const Numbers&, const Numbers&) = default;
};

/// Any value of a scene file. Arrays of numbers and of equal short tuples of numbers are always held as
/// Numbers, so that a mesh takes 8 bytes per number; integers beyond 2^53 are kept as such. Objects are
/// sorted by key.
struct Value {
    using Array = std::vector<Value>;
    using Object = std::map<std::string, Value, std::less<>>;

    std::variant<std::monostate, bool, double, std::int64_t, std::uint64_t, std::string, Array, Object,
                 Numbers>
        data;

    Value() = default;
    explicit Value(bool flag) : data(flag) {}
    Value(double number) : data(number) {}
    /// A double when it holds the integer exactly.
    explicit Value(std::int64_t number);
    explicit Value(std::uint64_t number);
    Value(std::string text) : data(std::move(text)) {}
    Value(const char* text) : data(std::string(text)) {}
    Value(Array array) : data(std::move(array)) {}
    Value(Object object) : data(std::move(object)) {}
    Value(Numbers numbers) : data(std::move(numbers)) {}

    bool isNull() const { return std::holds_alternative<std::monostate>(data); }
    template <class T>
    const T* as() const {
        return std::get_if<T>(&data);
    }
    template <class T>
    T* as() {
        return std::get_if<T>(&data);
    }

    friend bool operator==(const Value&, const Value&) = default;
};

/// What a value is, in the words of a message: `number 1.7`, `"abc"`, `an array of 3 elements`.
std::string describe(const Value& value);

/// The shortest decimal text that reads back as the same double; integers of up to 2^53 in plain digits, -0.0
/// with its sign. Not-finite numbers as the words inf, -inf, nan, without quotes.
std::string numberText(double number);

/// Appends without allocating.
void appendNumber(std::string& text, double number);
/// The same for a number that a float holds: shortest text that reads back as the same float.
void appendFloat(std::string& text, double number);

/// The value under a key of an object, null where there is none or one of another kind.
template <class T>
const T* member(const Value::Object& object, std::string_view key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : found->second.as<T>();
}

} // namespace tss
