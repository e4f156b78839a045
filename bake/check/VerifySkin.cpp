#include "bake/check/VerifySkin.h"

#include "bake/base/Parallel.h"
#include "bake/geometry/Bvh.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/model/SourceHash.h"
#include "bake/motion/MuscleTrack.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/play/SkinSetup.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unordered_set>

namespace tss {

namespace {

/// Files hold places and radii as floats.
constexpr double floatRounding = 0x1p-22;

double reachOf(const TriangleMesh& mesh) {
    double most = 0;
    for (const Vec3& v : mesh.vertices) most = std::max(most, v.norm());
    return most;
}

/// Half the mean edge.
double usualThickness(const TriangleMesh& skin) {
    double sum = 0;
    for (const Tri& t : skin.triangles)
        for (int k = 0; k < 3; ++k) sum += (skin.vertices[t[k]] - skin.vertices[t[(k + 1) % 3]]).norm();
    return sum / (6.0 * static_cast<double>(std::max<std::size_t>(1, skin.triangles.size())));
}

class Checker {
public:
    Checker(const SceneModel& scene, const SkinModel& skin)
        : made_(*skin.table), table_(made_.table), mesh_(scene.bodies[skin.body].mesh),
          muscles_(skinMuscles(scene, skin)),
          thickness_(skin.thickness > 0 ? skin.thickness : usualThickness(mesh_)),
          rounding_(floatRounding * (reachOf(mesh_) + thickness_)), metersPerUnit_(scene.metersPerUnit) {
        const BakeOptions options = optionsFor(skin.settings, {}, scene.metersPerUnit);
        contained_ = options.conservative &&
                     (options.spheres == SphereMethod::Medial || options.spheres == SphereMethod::Shrinking);
    }

    SkinVerdict run(const Progress& progress) {
        for (const auto check :
             {&Checker::claims, &Checker::skinSpheres, &Checker::rows, &Checker::thresholds}) {
            verdict_.reason = (this->*check)();
            if (!verdict_.holds()) return verdict_;
        }
        std::vector<Eigen::AlignedBox3d> boxes(mesh_.vertices.begin(), mesh_.vertices.end());
        vertices_ = buildBvh(boxes);
        for (std::uint32_t m = 0; m < muscles_.size() && verdict_.holds(); ++m) {
            if (!report(progress, "verify", double(m) / double(muscles_.size())))
                verdict_.reason = "stopped before all was looked at";
            else
                muscle(m);
        }
        if (verdict_.holds()) judgeLateness();
        return verdict_;
    }

private:
    std::string claims() {
        if (table_.certified || table_.boundMiss || table_.boundEarly || table_.epsilon > 0 ||
            table_.gapDepth > 0 || table_.gapMargin > 0 || !table_.restRegion.empty())
            return "it says that it is certified or states a bound, and none is proven of a skin";
        return {};
    }

    std::string skinSpheres() {
        if (made_.skinVertices.size() != table_.a.size() || made_.muscleOf.size() != table_.b.size())
            return "not every sphere of it has its vertex or its muscle";
        rowOf_.assign(mesh_.vertices.size(), -1);
        for (std::size_t i = 0; i < table_.a.size(); ++i) {
            const std::uint32_t v = made_.skinVertices[i];
            if (v >= mesh_.vertices.size() || rowOf_[v] >= 0)
                return fmt::format("its skin sphere {} rides on no vertex of its own", i);
            rowOf_[v] = std::ptrdiff_t(i);
            if (!((table_.a[i].centre - mesh_.vertices[v]).norm() <= rounding_))
                return fmt::format("its skin sphere {} does not stand at its vertex", i);
            if (!(std::abs(table_.a[i].radius - thickness_) <= rounding_))
                return fmt::format("its skin sphere {} is not as large as the skin is thick", i);
        }
        for (const std::uint32_t m : made_.muscleOf)
            if (m >= muscles_.size()) return "a sphere of it belongs to no muscle";
        return {};
    }

    std::string rows() {
        if (table_.rowOffsets.size() != table_.a.size() + 1) return "its rows are not those of its spheres";
        for (std::size_t i = 0; i < table_.a.size(); ++i)
            for (std::uint32_t k = table_.rowOffsets[i]; k < table_.rowOffsets[i + 1]; ++k)
                tests_.insert(key(i, table_.columns[k]));
        return {};
    }

    std::string thresholds() {
        for (std::size_t i = 0; i < table_.a.size(); ++i)
            for (std::uint32_t k = table_.rowOffsets[i]; k < table_.rowOffsets[i + 1]; ++k) {
                const Sphere &a = table_.a[i], &b = table_.b[table_.columns[k]];
                const double gap = (a.centre - b.centre).norm() - a.radius - b.radius;
                const double stored = table_.restGaps.empty() ? 0 : table_.restGaps[k];
                if (!(std::abs(stored - std::min(0.0, gap)) <= 4 * rounding_))
                    return fmt::format("the threshold of its test {} is not its gap at rest", k);
            }
        return {};
    }

    static std::uint64_t key(std::size_t row, std::uint32_t column) {
        return std::uint64_t(row) << 32 | column;
    }
    bool tested(std::uint32_t vertex, std::uint32_t sphere) const {
        return rowOf_[vertex] >= 0 && tests_.contains(key(std::size_t(rowOf_[vertex]), sphere));
    }

    void muscle(std::uint32_t m) {
        const MuscleDeformer& deformer = *muscles_[m];
        const std::vector<double> nodes =
            activationNodes(deformer.muscle().activationLower, deformer.muscle().activationUpper);
        std::vector<std::uint32_t> spheres;
        std::vector<MusclePoint> points;
        for (std::uint32_t j = 0; j < table_.b.size(); ++j)
            if (made_.muscleOf[j] == m) {
                spheres.push_back(j);
                points.push_back(deformer.bind(table_.b[j].centre));
            }
        const MuscleTrack track = makeTrack(deformer, points, nodes);
        std::vector<std::ptrdiff_t> missing(spheres.size(), -1);
        parallelFor(spheres.size(), [&](std::size_t p) { missing[p] = untested(track, p, spheres[p]); });
        for (std::size_t p = 0; p < spheres.size(); ++p)
            if (missing[p] >= 0) {
                verdict_.reason = fmt::format("its sphere {} of muscle {} comes near vertex {} of the skin, "
                                              "and no test is made of them",
                                              spheres[p], m, missing[p]);
                return;
            }
        for (std::size_t n = 0; n < nodes.size(); ++n) nearness(deformer, track, n, spheres);
    }

    /// A vertex that a sphere on its track comes within travel of at rest without a test of the two; -1:
    /// none.
    std::ptrdiff_t untested(const MuscleTrack& track, std::size_t p, std::uint32_t sphere) const {
        std::ptrdiff_t found = -1;
        for (std::size_t n = 0; n < track.nodes.size() && found < 0; ++n) {
            const std::size_t last = std::min(n + 1, track.nodes.size() - 1);
            const std::size_t from = n * track.points + p, to = last * track.points + p;
            const Vec3 &a = track.positions[from], &b = track.positions[to];
            const double radius =
                table_.b[sphere].radius * std::min(track.thicknesses[from], track.thicknesses[to]);
            const double near = radius + thickness_ + made_.travel - 4 * rounding_;
            const Vec3 way = b - a;
            const double length = way.squaredNorm();
            visitBall(vertices_, 0.5 * (a + b), 0.5 * std::sqrt(length) + near, [&](std::uint32_t v) {
                const Vec3 arm = mesh_.vertices[v] - a;
                const double t = length > 0 ? std::clamp(arm.dot(way) / length, 0.0, 1.0) : 0;
                if ((arm - t * way).norm() < near && !tested(v, sphere)) found = v;
            });
        }
        return found;
    }

    /// How much nearer the muscle's surface is to a vertex than the tests there say.
    void nearness(const MuscleDeformer& deformer, const MuscleTrack& track, std::size_t node,
                  const std::vector<std::uint32_t>& spheres) {
        ++verdict_.states;
        TriangleMesh surface = deformer.muscle().surface;
        surface.vertices = deformer.vertices(track.nodes[node]);
        const MeshQuery query(surface);
        std::vector<double> late(mesh_.vertices.size(), 0);
        parallelFor(mesh_.vertices.size(), [&](std::size_t v) {
            const double distance = query.distance(mesh_.vertices[v], thickness_);
            if (!(distance < thickness_ - rounding_)) return;
            double told = std::numeric_limits<double>::infinity();
            for (std::size_t p = 0; p < spheres.size(); ++p) {
                const std::size_t at = node * track.points + p;
                const double gap = (track.positions[at] - mesh_.vertices[v]).norm() -
                                   table_.b[spheres[p]].radius * track.thicknesses[at];
                if (gap < told && tested(std::uint32_t(v), spheres[p])) told = gap;
            }
            late[v] = told - distance;
        });
        const double latest = *std::ranges::max_element(late);
        verdict_.late = std::max(verdict_.late, latest);
        if (track.nodes[node] == 0) verdict_.lateAtRest = std::max(verdict_.lateAtRest, latest);
    }

    void judgeLateness() {
        const double granted = 4 * rounding_;
        if (contained_ && verdict_.lateAtRest > granted)
            verdict_.reason = fmt::format("at rest a muscle is {} nearer to the skin than its tests say",
                                          lengthText(verdict_.lateAtRest, metersPerUnit_));
        else if (verdict_.late > thickness_ && (contained_ || std::isinf(verdict_.late)))
            verdict_.reason = fmt::format("a muscle by itself comes {} nearer to the skin than its tests say",
                                          lengthText(verdict_.late, metersPerUnit_));
        if (!verdict_.holds()) return;
        verdict_.notes.push_back(
            fmt::format("looked at with the skin and the bones at rest, each muscle by itself at {} "
                        "activations together: its tests are all there, and late by up to {}, {} at rest",
                        verdict_.states, lengthText(verdict_.late, metersPerUnit_),
                        lengthText(verdict_.lateAtRest, metersPerUnit_)));
        verdict_.notes.push_back("nothing is proven of a skin that moves, of several muscles at once or of "
                                 "bones: its rows are found by search");
    }

    const SkinTable& made_;
    const Table& table_;
    const TriangleMesh& mesh_;
    std::vector<std::shared_ptr<const MuscleDeformer>> muscles_;
    double thickness_, rounding_, metersPerUnit_;
    bool contained_ = false;            ///< the spheres were to contain the muscles' surfaces
    std::vector<std::ptrdiff_t> rowOf_; ///< each vertex; -1: none
    std::unordered_set<std::uint64_t> tests_;
    Bvh vertices_;
    SkinVerdict verdict_;
};

} // namespace

SkinVerdict verifySkin(const SceneModel& scene, const SkinModel& skin, const Progress& progress) {
    SkinVerdict verdict;
    if (!skin.table) {
        verdict.reason = "has not been baked";
        return verdict;
    }
    verdict.reason = staleness(scene, skin);
    if (!verdict.holds()) return verdict;
    return Checker(scene, skin).run(progress);
}

} // namespace tss
