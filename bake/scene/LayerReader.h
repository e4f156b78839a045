#pragma once
#include "bake/scene/Buffers.h"
#include "bake/scene/ReadLayer.h"

namespace tss {

/// The tree as parsed, as a layer. Values are moved out of it.
struct LayerReader {
    Problems& problems;
    BufferReader* buffers = nullptr; ///< for values that stand in them

    Layer readLayer(Value root);
    Property readProperty(Value::Object keys, const Place& place);

private:
    Value::Object* object(Value& value, const Place& place);
    std::string takeText(Value::Object& keys, const char* key, const char* fallback, const Place& place);
    void checkVersion(const std::string& version, const Place& place);
    Value::Object takeMetadata(Value::Object& keys, const Place& place);
    void takeProperties(Value::Object& keys, Prim& prim, const Place& place);
    Prim readPrim(Value::Object& keys, const std::string& name, const Place& place);
    std::vector<Prim> takeChildren(Value::Object& keys, const Place& place);

    /// Checks an array of strings or a list op of such: {"prepend": [...], "append": ..., "delete": ...,
    /// "explicit": ...}. wanted: what the strings are, for the message.
    void checkList(const Value& value, const Place& place, const char* wanted);
    /// Checks that the strings of such a list are absolute paths of prims or properties.
    void checkPaths(const Value& value, const Place& place);
    /// A value of an attribute, in the form that its type has.
    void readValue(Value& value, const std::string& typeName, const Place& place);
    /// Splits [[t, v], ...], in whatever form the parser found for it.
    std::vector<Property::Sample> splitSamples(Value& value, const Place& place);
    void readAttribute(Value::Object& keys, Property& property, const Place& place);
};

} // namespace tss
