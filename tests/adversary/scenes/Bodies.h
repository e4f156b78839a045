#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "tests/search/Scenes.h"

namespace adversary {

using scenes::Random;
using tss::Tri;
using tss::TriangleMesh;
using tss::Vec3;

/// From lower to upper, evenly in the logarithm; both > 0.
double logUniform(Random& random, double lower, double upper);

/// Points of a profile in a half plane: distance from the Z axis, height. A distance of 0 is a pole.
using Profile = std::vector<std::pair<double, double>>;

/// The surface that a profile sweeps about the Z axis; outward where the profile runs upwards on the outside.
TriangleMesh revolved(const Profile& profile, int segments);

/// A ball whose surface rises to `height` above its radius around each of the directions.
TriangleMesh bumpyBall(double radius, int level, const std::vector<Vec3>& bumps, double height, double width);

/// A closed spike with a base of three to five corners.
TriangleMesh needle(const Vec3& base, const Vec3& tip, double radius, int corners);

/// A hollow ball with a wall: closed, the inner side turned inwards.
TriangleMesh shell(double outer, double inner, int level);

/// A bowl, open towards +Z, that leaves `opening` radians of the ball; wall 0: a surface without a thickness.
TriangleMesh bowl(double radius, double wall, double opening, int rings, int segments);

TriangleMesh turnedBy(TriangleMesh mesh, const Eigen::Quaterniond& turn);
TriangleMesh movedBy(TriangleMesh mesh, const Vec3& way);
Eigen::Quaterniond anyTurn(Random& random);

/// Points inserted into triangles so close to a corner or an edge that slivers are left, `share` of a
/// triangle off.
TriangleMesh withSlivers(Random& random, TriangleMesh mesh, int count, double share);

/// Each triangle with vertices of its own, off their place by up to `jitter`.
TriangleMesh unwelded(Random& random, const TriangleMesh& mesh, double jitter);

/// Edges cut in one of their two triangles only.
TriangleMesh withTJunctions(Random& random, TriangleMesh mesh, int count);

/// Without the triangles whose middle lies within `reach` of a place of the surface.
TriangleMesh opened(Random& random, const TriangleMesh& mesh, double reach);

/// A triangle without area: the segment, as one of the ways to spell it; or a point where from == to.
void addWire(Random& random, TriangleMesh& mesh, const Vec3& from, const Vec3& to);

} // namespace adversary
