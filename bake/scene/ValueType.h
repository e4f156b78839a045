#pragma once
#include "bake/scene/Problems.h"
#include "bake/scene/Value.h"

#include <string>
#include <string_view>

namespace tss {

/// What an attribute's typeName says of its value, in USD's names: `float`, `point3f[]`, `matrix4d`,
/// `token[]`, ...
struct ValueType {
    enum class Base { Bool, Integer, Half, Float, Double, Text };
    Base base = Base::Double;
    int width = 1; ///< numbers in one element: 3 of point3f, 4 of quatf and of a row of matrix4d
    int rows = 1;  ///< of a matrix
    double lowest = 0, highest = 0; ///< of an integer
    bool array = false;
    std::string name = {};              ///< as USD has it: point3f[]
    const ValueType* element = nullptr; ///< of an array

    bool isReal() const { return base == Base::Half || base == Base::Float || base == Base::Double; }
    /// Its numbers are stored and written as float.
    bool isFloat() const { return base == Base::Half || base == Base::Float; }
};

/// Nothing when the name is not one of USD's value types; such values are kept as they are.
const ValueType* valueType(std::string_view typeName);

/// Checks a value against its type and brings it into the form that the rest of the code relies on: "inf",
/// "-inf", "nan" become numbers, numbers of float slots are rounded to float, arrays of numbers are Numbers
/// with the type's width. null is left as it is. What is wrong goes to problems, with what was expected.
void conform(Value& value, const ValueType& type, const Place& place, Problems& problems);

} // namespace tss
