#pragma once
#include <limits>
#include <string_view>
#include <vector>

namespace tss {

/// Numbers that a slot accepts; infinite ends are open, not-finite numbers are never in a range.
struct Range {
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
};
constexpr Range anyNumber{};
constexpr Range atLeast(double lowest) {
    return {lowest};
}
constexpr Range between(double lowest, double highest) {
    return {lowest, highest};
}

/// An attribute or a relationship that osgTSS reads and writes, with what docs/FORMAT.md and the JSON Schema
/// say of it.
struct Attribute {
    std::string_view name;
    std::string_view typeName;     ///< as USD has it; "rel": a relationship
    bool uniform = false;          ///< does not change over time
    Range range = {};              ///< of its numbers
    std::string_view choices = {}; ///< tokens that it may have, with spaces between; the first when absent
    std::string_view meaning = {};
};

/// The same as .usda declares it: "uniform double tss:epsilon", "rel tss:bodies".
constexpr Attribute declared(std::string_view text, std::string_view meaning = {}, Range range = {},
                             std::string_view choices = {}) {
    constexpr std::string_view uniform = "uniform ";
    const bool isUniform = text.starts_with(uniform);
    if (isUniform) text.remove_prefix(uniform.size());
    const auto space = text.find(' ');
    return {text.substr(space + 1), text.substr(0, space), isUniform, range, choices, meaning};
}

/// What a prim of a type, or with an API schema, may have, in the order of docs/FORMAT.md.
struct SchemaType {
    std::string_view name;
    std::vector<Attribute> attributes;
};

/// All that osgTSS reads and writes.
const std::vector<SchemaType>& schemaTypes();

struct Layer;
class Problems;

/// Warns of properties that begin as osgTSS's or UsdPhysics' do and are none of them, with the name that was
/// meant where one is near: a misspelt property is else kept and does nothing. So are faces that are holes.
void remarkTypos(const Layer& layer, Problems& problems);

namespace schema {

// Of more than one type, or read outside of the file that has the type
inline constexpr Attribute points = declared("point3f[] points");
inline constexpr Attribute faceVertexCounts = declared("int[] faceVertexCounts", "", between(3, 1e4));
inline constexpr Attribute faceVertexIndices = declared("int[] faceVertexIndices");
inline constexpr Attribute subdivisionScheme = declared("uniform token subdivisionScheme");
inline constexpr Attribute displayColor = declared("color3f[] primvars:displayColor");
inline constexpr Attribute visibility = declared("token visibility", "", {}, "inherited invisible");
inline constexpr Attribute extent = declared("float3[] extent");
inline constexpr Attribute xformOpOrder = declared("uniform token[] xformOpOrder");
inline constexpr Attribute body0 = declared("rel physics:body0");
inline constexpr Attribute body1 = declared("rel physics:body1");
inline constexpr Attribute localPos0 = declared("point3f physics:localPos0");
inline constexpr Attribute localPos1 = declared("point3f physics:localPos1");
inline constexpr Attribute localRot0 = declared("quatf physics:localRot0");
inline constexpr Attribute localRot1 = declared("quatf physics:localRot1");
inline constexpr Attribute jointEnabled = declared("bool physics:jointEnabled");
inline constexpr Attribute axis = declared("uniform token physics:axis", "", {}, "X Y Z");
inline constexpr Attribute lowerLimit = declared("float physics:lowerLimit");
inline constexpr Attribute upperLimit = declared("float physics:upperLimit");
inline constexpr Attribute coneAngle0 = declared("float physics:coneAngle0Limit");
inline constexpr Attribute coneAngle1 = declared("float physics:coneAngle1Limit");
inline constexpr Attribute bodies =
    declared("rel tss:bodies", "of a pair on a prim that is no joint: its two bodies");
inline constexpr Attribute table = declared("rel tss:table", "the result of a bake");
inline constexpr Attribute bone = declared("rel tss:bone", "the body that it rides on; none: the skin");
inline constexpr Attribute originBone =
    declared("rel tss:originBone", "instead of `tss:bone`: the body that its origin moves with");
inline constexpr Attribute insertionBone =
    declared("rel tss:insertionBone", "the body that its insertion moves with");
inline constexpr Attribute bones = declared(
    "rel tss:bones", "the bodies that it lies on and moves with: any meshes, open or of several shells");
inline constexpr Attribute skelJoints =
    declared("uniform token[] skel:joints", "paths of the bodies that weights of one's own name");

/// Settings of a bake: tss:bake:<option of `tss bake`, - written as _>, a string each.
inline constexpr std::string_view bakePrefix = "tss:bake:";

/// The key in customData for the name that a node had in the OSG graph it came from.
inline constexpr const char* originalName = "osgName";
inline constexpr const char* nameless = "nameless"; ///< true: the name was made up

} // namespace schema
} // namespace tss
