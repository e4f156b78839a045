#pragma once
#include "tests/Joints.h"
#include "tests/extreme/scenes/ExtremeScene.h"

namespace extreme {

using tss::Dof;
using tss::Motion;
using tss::SceneModel;
using tss::Tri;
using tss::TriangleMesh;
using tss::Vec3;

inline constexpr double degree = 0.017453292519943295;

/// As joints:: has them, but a turn with limits in degrees.
Dof turn(const Vec3& origin, const Vec3& axis, double lower, double upper);
using joints::slide;

/// A ball of triangles whose vertices stray by up to `rough` of the radius, always the same way: no two of
/// its spheres are equal, so that no tie hides behind a symmetry.
TriangleMesh roughBall(const Vec3& centre, double radius, int level, double rough = 0.03);

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other);

/// All vertices as the file holds them, in float.
TriangleMesh inFloat(TriangleMesh mesh);

/// Two bodies and one joint that is driven from its lower limit to its upper and back over 48 time codes.
/// tolerance: of the bake, in scene units; 0: the default.
SceneModel pairScene(TriangleMesh a, TriangleMesh b, const Motion& motion, double tolerance);

/// A rough ball of radius 10 and one of radius 5 that swings into it about the Z axis and slides along it,
/// times `unit`: the pair that most cases are made of.
SceneModel swing(double unit = 1);

/// The same with the turn alone.
SceneModel hinge(double lower = -40, double upper = 90);

/// The text of the scene's file.
std::string textOf(const SceneModel& scene);

/// The text with one part replaced; throws std::logic_error where the part is not there.
std::string edited(std::string text, const std::string& from, const std::string& to);

std::vector<ExtremeScene> unitScenes();
std::vector<ExtremeScene> contactScenes();
std::vector<ExtremeScene> meshScenes();
std::vector<ExtremeScene> limitScenes();
std::vector<ExtremeScene> skinScenes();

} // namespace extreme
