#pragma once
#include "bake/table/Table.h"

#include <utility>

namespace tss {

/// An attribute that osgTSS reads and writes: its name and type as USD has them.
struct Attribute {
    const char* name;
    const char* typeName;
    bool uniform = false; ///< does not change over time
};

/// The attributes and relationships of a scene file, each in one place (docs/FORMAT.md has their meaning).
namespace schema {

// UsdGeom
inline constexpr Attribute points{"points", "point3f[]"};
inline constexpr Attribute faceVertexCounts{"faceVertexCounts", "int[]"};
inline constexpr Attribute faceVertexIndices{"faceVertexIndices", "int[]"};
inline constexpr Attribute subdivisionScheme{"subdivisionScheme", "token", true};
inline constexpr Attribute orientation{"orientation", "token", true};
inline constexpr Attribute doubleSided{"doubleSided", "bool", true};
inline constexpr Attribute extent{"extent", "float3[]"};
inline constexpr Attribute displayColor{"primvars:displayColor", "color3f[]"};
inline constexpr Attribute visibility{"visibility", "token"};
inline constexpr Attribute purpose{"purpose", "token", true};
inline constexpr Attribute widths{"widths", "float[]"};
inline constexpr Attribute xformOpOrder{"xformOpOrder", "token[]", true};
inline constexpr Attribute translate{"xformOp:translate", "double3"};
inline constexpr Attribute orient{"xformOp:orient", "quatd"};

// UsdPhysics
inline constexpr const char* body0 = "physics:body0";
inline constexpr const char* body1 = "physics:body1";
inline constexpr Attribute localPos0{"physics:localPos0", "point3f"};
inline constexpr Attribute localPos1{"physics:localPos1", "point3f"};
inline constexpr Attribute localRot0{"physics:localRot0", "quatf"};
inline constexpr Attribute localRot1{"physics:localRot1", "quatf"};
inline constexpr Attribute jointEnabled{"physics:jointEnabled", "bool"};
inline constexpr Attribute collisionEnabled{"physics:collisionEnabled", "bool"};
inline constexpr Attribute axis{"physics:axis", "token", true};
inline constexpr Attribute lowerLimit{"physics:lowerLimit", "float"};
inline constexpr Attribute upperLimit{"physics:upperLimit", "float"};
inline constexpr Attribute coneAngle0{"physics:coneAngle0Limit", "float"};
inline constexpr Attribute coneAngle1{"physics:coneAngle1Limit", "float"};

// Joints, ours
inline constexpr Attribute dofOrder{"tss:dofOrder", "token[]", true};
inline constexpr Attribute dofNames{"tss:dofNames", "token[]", true};
inline constexpr Attribute dofScale{"tss:dofScale", "double[]", true};
inline constexpr Attribute rest{"tss:rest", "double[]", true};
inline constexpr Attribute limitPlanes{"tss:limitPlanes", "double[]", true};
inline constexpr Attribute paths{"tss:paths", "double[]", true};
inline constexpr Attribute pathRows{"tss:pathRows", "int[]", true};
inline constexpr Attribute pathLimits{"tss:pathLimits", "double2[]", true};

// TssPairAPI
inline constexpr const char* bodies = "tss:bodies";
inline constexpr const char* table = "tss:table";

// TssTable, TssNeverCollides
inline constexpr const char* spheres0 = "tss:spheres0";
inline constexpr const char* spheres1 = "tss:spheres1";
inline constexpr Attribute rowOffsets{"tss:rowOffsets", "int[]", true};
inline constexpr Attribute columns{"tss:columns", "int[]", true};
inline constexpr Attribute dofs{"tss:dofs", "token[]", true};
inline constexpr Attribute lower{"tss:lower", "double[]", true};
inline constexpr Attribute upper{"tss:upper", "double[]", true};
inline constexpr Attribute restGaps{"tss:restGaps", "double[]", true};
inline constexpr Attribute restTriangles0{"tss:restTriangles0", "int[]", true};
inline constexpr Attribute restTriangles1{"tss:restTriangles1", "int[]", true};
inline constexpr Attribute restCuts0{"tss:restCuts0", "int[]", true};
inline constexpr Attribute restCuts1{"tss:restCuts1", "int[]", true};
inline constexpr Attribute restDepth{"tss:restDepth", "double", true};
inline constexpr Attribute epsilon{"tss:epsilon", "double", true};
inline constexpr Attribute gapDepth{"tss:gapDepth", "double", true};
inline constexpr Attribute gapMargin{"tss:gapMargin", "double", true};
inline constexpr Attribute boundMiss{"tss:boundMiss", "double", true};
inline constexpr Attribute boundEarly{"tss:boundEarly", "double", true};
inline constexpr Attribute certified{"tss:certified", "bool", true};
inline constexpr Attribute method{"tss:method", "token", true};
inline constexpr Attribute sourceHash{"tss:sourceHash", "string", true};
inline constexpr Attribute clearance{"tss:clearance", "double", true};
inline constexpr Attribute cells{"tss:cells", "uint64", true};
inline constexpr Attribute skinVertices{"tss:skinVertices", "int[]", true};
inline constexpr Attribute muscleOf{"tss:muscleOf", "int[]", true};
inline constexpr Attribute tableTravel{"tss:travel", "double", true};
inline constexpr Attribute generatedSpheres{"tss:generatedSpheres", "uint64[]", true};
inline constexpr Attribute candidatePairs{"tss:candidatePairs", "uint64", true};
inline constexpr Attribute lowerBound{"tss:lowerBound", "uint64", true};
inline constexpr Attribute coverage{"tss:coverage", "double[]", true};
inline constexpr Attribute protrusion{"tss:protrusion", "double[]", true};
inline constexpr Attribute coverageMean{"tss:coverageMean", "double[]", true};
inline constexpr Attribute coverageP95{"tss:coverageP95", "double[]", true};
inline constexpr Attribute protrusionMean{"tss:protrusionMean", "double[]", true};
inline constexpr Attribute protrusionP95{"tss:protrusionP95", "double[]", true};
inline constexpr Attribute volumeRatio{"tss:volumeRatio", "double[]", true};

/// Where each figure of a fit is kept: one number a body.
inline constexpr std::pair<Attribute, double FitRecord::*> fitFigures[] = {
    {coverage, &FitRecord::coverage},
    {protrusion, &FitRecord::protrusion},
    {coverageMean, &FitRecord::coverageMean},
    {coverageP95, &FitRecord::coverageP95},
    {protrusionMean, &FitRecord::protrusionMean},
    {protrusionP95, &FitRecord::protrusionP95},
    {volumeRatio, &FitRecord::volumeRatio}};

// TssMuscle
inline constexpr const char* surface = "tss:surface";
inline constexpr const char* bone = "tss:bone";
inline constexpr const char* originBone = "tss:originBone";
inline constexpr const char* insertionBone = "tss:insertionBone";
inline constexpr Attribute origin{"tss:origin", "point3f", true};
inline constexpr Attribute insertion{"tss:insertion", "point3f", true};
inline constexpr Attribute fibre{"tss:fibre", "point3f[]", true};
inline constexpr Attribute form{"tss:form", "token", true};
inline constexpr Attribute anchor{"tss:anchor", "double", true};
inline constexpr Attribute maxContraction{"tss:maxContraction", "double", true};
inline constexpr Attribute activationRange{"tss:activationRange", "double2", true};
inline constexpr Attribute activation{"tss:activation", "double"};

// TssSkinAPI
inline constexpr const char* bones = "tss:bones";
inline constexpr const char* muscles = "tss:muscles";
inline constexpr Attribute thickness{"tss:thickness", "double", true};
inline constexpr Attribute travel{"tss:travel", "double", true};
inline constexpr Attribute stretchCompliance{"tss:stretchCompliance", "double", true};
inline constexpr Attribute bendCompliance{"tss:bendCompliance", "double", true};
inline constexpr Attribute selfContact{"tss:selfContact", "bool", true};
inline constexpr Attribute tether{"primvars:tss:tether", "float[]"};
inline constexpr Attribute attach{"primvars:tss:attach", "float[]"};
// UsdSkel's, of a skin with weights of its own
inline constexpr Attribute skelJoints{"skel:joints", "token[]", true};
inline constexpr Attribute jointIndices{"primvars:skel:jointIndices", "int[]"};
inline constexpr Attribute jointWeights{"primvars:skel:jointWeights", "float[]"};

/// Settings of a bake: tss:bake:<option of `tss bake`, - written as _>, a string each.
inline constexpr const char* bakePrefix = "tss:bake:";

/// The key in customData for the name that a node had in the OSG graph it came from.
inline constexpr const char* originalName = "osgName";

} // namespace schema
} // namespace tss
