#pragma once
#include "tests/usd/Stages.h"

#include <string>

/// An arm along z of three joints, each 2 long, as one square tube; `skeleton`, `animation` and `mesh` are
/// lines more in these prims. The elbow turns about x by 0, 60 and -40 degrees at 0, 12 and 24; the animation
/// has its joints in another order than the skeleton, and moves the hand along with it, which stands.
inline std::string armStage(const std::string& skeleton = "", const std::string& mesh = "",
                            const std::string& root = "", const std::string& weights = "") {
    std::string points, faces, counts, indices, numbers;
    const auto add = [](std::string& list, const std::string& item) {
        list += (list.empty() ? "" : ", ") + item;
    };
    const std::string corners[] = {"-0.5, -0.5", "0.5, -0.5", "0.5, 0.5", "-0.5, 0.5"};
    for (int ring = 0; ring < 7; ++ring)
        for (int k = 0; k < 4; ++k) {
            add(points, "(" + corners[k] + ", " + std::to_string(ring) + ")");
            const int bone = ring < 2 ? 0 : ring < 5 ? 1 : 2; // of the order elbow, shoulder, hand below
            add(indices, std::string(bone == 0 ? "1, 0" : bone == 1 ? "0, 1" : "2, 1"));
            add(numbers, ring == 2 ? "0.5, 0.5" : "1, 0");
        }
    const auto quad = [&](int a, int b, int c, int d) {
        for (const int k : {a, b, c, d}) add(faces, std::to_string(k));
        add(counts, "4");
    };
    quad(3, 2, 1, 0);
    for (int ring = 0; ring < 6; ++ring)
        for (int k = 0; k < 4; ++k)
            quad(4 * ring + k, 4 * ring + (k + 1) % 4, 4 * ring + 4 + (k + 1) % 4, 4 * ring + 4 + k);
    quad(24, 25, 26, 27);
    const auto bind = [](int z) {
        return "((1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0," + std::to_string(z) + ",1))";
    };
    return "( defaultPrim = \"Arm\"\n metersPerUnit = 0.01\n upAxis = \"Z\" )\n"
           "def SkelRoot \"Arm\" {\n rel skel:skeleton = </Arm/Skel>\n rel skel:animationSource = "
           "</Arm/Wave>\n" +
           root + R"usda(
 def Skeleton "Skel" {
  uniform token[] joints = ["Shoulder", "Shoulder/Elbow", "Shoulder/Elbow/Hand"]
  uniform matrix4d[] bindTransforms = [)usda" +
           bind(0) + ", " + bind(2) + ", " + bind(4) + "]\n  uniform matrix4d[] restTransforms = [" +
           bind(0) + ", " + bind(2) + ", " + bind(2) + "]\n" + skeleton + R"usda(
 }
 def SkelAnimation "Wave" {
  uniform token[] joints = ["Shoulder/Elbow/Hand", "Shoulder/Elbow"]
  float3[] translations = [(0, 0, 2), (0, 0, 2)]
  quatf[] rotations.timeSamples = {
   0: [(1, 0, 0, 0), (1, 0, 0, 0)],
   12: [(1, 0, 0, 0), (0.8660254, 0.5, 0, 0)],
   24: [(1, 0, 0, 0), (0.9396926, -0.3420201, 0, 0)] }
  half3[] scales = [(1, 1, 1), (1, 1, 1)]
 }
 def Mesh "Skin" {
  uniform token subdivisionScheme = "none"
  uniform token[] skel:joints = ["Shoulder/Elbow", "Shoulder", "Shoulder/Elbow/Hand"]
  point3f[] points = [)usda" +
           points + "]\n  int[] faceVertexCounts = [" + counts + "]\n  int[] faceVertexIndices = [" + faces +
           "]\n" +
           (weights.empty() ? "  int[] primvars:skel:jointIndices = [" + indices +
                                  "] ( interpolation = \"vertex\" elementSize = 2 )\n"
                                  "  float[] primvars:skel:jointWeights = [" +
                                  numbers + "] ( interpolation = \"vertex\" elementSize = 2 )\n"
                            : weights) +
           mesh + "\n }\n}\n";
}
