#include "bake/motion/MayMeet.h"

#include "bake/motion/CellTools.h"

#include <algorithm>
#include <vector>

namespace tss {

BallAbout::BallAbout(const TriangleMesh& mesh) {
    centre = mesh.vertices.empty() ? Vec3(Vec3::Zero()) : bounds(mesh).center();
    for (const Vec3& vertex : mesh.vertices) radius = std::max(radius, (vertex - centre).norm());
}

namespace {

/// Bound of how far any point of the ball moves within the cell of `motion`.
double moveOf(const CellMotion& motion, const BallAbout& ball) {
    return motion.pointMotion(motion.centrePose() * ball.centre).move + motion.relativeMove() * ball.radius;
}

} // namespace

bool mayMeet(const MeshQuery& a, const MeshQuery& b, const BallAbout& inB, const Motion& motion) {
    constexpr int most = 1000; // cells
    const MotionRates rates(motion);
    const double rounding = coordinateRounding(motion, a.extent(), b.extent());
    std::vector<Cell> open{wholeBox(motion)};
    for (int looked = 0; !open.empty(); ++looked) {
        if (looked == most) return true;
        Cell cell = open.back();
        open.pop_back();
        if (!shrinkToPlanes(motion, cell)) continue;
        const CellMotion within(rates, cell);
        const double move = moveOf(within, inB) + rounding;
        const double distance = a.distanceTo(b, within.centrePose(), move);
        if (distance >= move) continue;
        if (distance <= 0 || motion.dofs.empty()) return true;
        const auto [lower, upper] = splitCell(rates, cell, widestDof(within, inB.centre, inB.radius));
        open.insert(open.end(), {lower, upper});
    }
    return false;
}

} // namespace tss
