#include "tests/extreme/tool/Serve.h"

#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/model/Kinematics.h"
#include "bake/play/Player.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "bake/table/Query.h"
#include "bake/table/TableKernels.h"
#include "bake/table/TablePairs.h"
#include "tests/Shapes.h"
#include "tests/extreme/scenes/ExtremeScene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <random>

namespace extreme {

namespace {

using namespace tss;

class Journey {
public:
    Journey(const std::string& name, const ServeOptions& options) : name_(name), options_(options) {}

    Outcome run(const std::string& text) {
        try {
            SceneModel scene = readText(text, name_);
            out_.read = true;
            BakeRequest request;
            request.given = options_.given;
            out_.reports = bake(scene, request, options_.progress);
            out_.text = writeJson(layerOf(scene));
            out_.scene = readText(out_.text, name_);
            if (writeJson(layerOf(out_.scene)) != out_.text)
                trouble("the baked file changes when it is read");
            for (const Pair& pair : out_.scene.pairs) checkPair(pair);
            play();
        } catch (const InputError& error) {
            out_.refusal = error.what();
            if (out_.refusal.empty()) trouble("refused without a word");
        }
        return std::move(out_);
    }

private:
    template <class... Parts>
    void trouble(fmt::format_string<Parts...> format, Parts&&... parts) {
        out_.troubles.push_back(fmt::format(format, std::forward<Parts>(parts)...));
    }

    bool stopped() const { return options_.progress && !options_.progress("stability", 0); }

    void checkPair(const Pair& pair) {
        PairFigures& figures = out_.pairs.emplace_back();
        figures.path = pair.path;
        figures.deepest = std::numeric_limits<double>::infinity();
        if (stopped()) return;
        figures.verdict = verifyPair(out_.scene, pair, options_.progress);
        if (!figures.verdict.holds() && !stopped()) trouble("{}: {}", pair.path, figures.verdict.reason);
        if (!pair.table) return;
        const Table& table = *pair.table;
        // With an epsilon and pairs that overlap at rest the bake says that how late contact may be reported
        // is not known.
        bool told = false;
        for (const PairReport& report : out_.reports)
            for (const std::string& note : report.notes)
                told = told || (report.path == pair.path && note.find("is not known") != std::string::npos);
        if (table.certified &&
            !((table.boundMiss || told) && table.boundEarly && std::isfinite(table.epsilon)))
            trouble("{}: certified, and states no bound", pair.path);
        figures.kernel = kernels(pair, table);
        compareMeshes(pair, table);
    }

    /// Every kernel against the plain query.
    KernelFigures kernels(const Pair& pair, const Table& table) {
        KernelFigures figures;
        const PreparedTable best(table);
        figures.form = best.form();
        figures.precision = best.precision();
        figures.condition = best.kernels().condition();
        figures.band = best.signBand();
        PrepareOptions single;
        single.precision = KernelPrecision::Float;
        figures.floatBand = PreparedTable(table, single).signBand();
        const auto poses = latticePoses(table.motion, options_.poses);
        for (const KernelTarget target : kernelTargets()) {
            PrepareOptions how;
            how.target = target;
            const PreparedTable prepared(table, how);
            TableFeatures features;
            int wrong = 0, notFinite = 0;
            for (const auto& q : poses) {
                const double exact = query(table, q).gap;
                prepared.features(q.data(), features);
                const bool hit = prepared.hit(features);
                notFinite += !std::isfinite(prepared.gap(features).gap);
                wrong += std::abs(exact) > prepared.signBand() && hit != (exact <= 0);
                if (table.testCount() == 0) continue; // no contact to speak of
                MotionFrame frame;
                prepared.frame(q.data(), frame);
                TableContact contact;
                prepared.contact(features, frame, contact);
                notFinite += !std::isfinite(contact.gap) || !contact.point.allFinite() ||
                             !(std::abs(contact.normal.norm() - 1) < 1e-9);
            }
            if (wrong) trouble("{}: {} says {} wrong verdicts", pair.path, tss::name(target), wrong);
            if (notFinite) trouble("{}: {} gives {} bad numbers", pair.path, tss::name(target), notFinite);
        }
        return figures;
    }

    /// Where the meshes go through each other the table must say contact. Not asked of pairs that overlap at
    /// rest and have an exception for it.
    void compareMeshes(const Pair& pair, const Table& table) {
        if (!table.certified || table.boundMiss != 0) return; // nothing is claimed
        if (!table.restGaps.empty() || !table.restRegion.empty() ||
            table.method.find("none") != std::string::npos)
            return;
        const auto setting = pair.settings.find("at-rest");
        if (setting != pair.settings.end() && setting->second == "ignore") return;
        const TriangleMesh a = cleaned(out_.scene.bodies[pair.bodyA].mesh),
                           b = cleaned(out_.scene.bodies[pair.bodyB].mesh);
        int missed = 0;
        for (const auto& q : latticePoses(table.motion, options_.poses)) {
            const Pose at = pose(table.motion, q);
            if (query(table, at).gap > 0) missed += meshesCross(a, b, at);
        }
        if (missed) trouble("{}: {} contacts of the meshes are missed", pair.path, missed);
    }

    std::vector<double> asked(double time, std::mt19937_64* random) const {
        std::vector<double> values;
        for (const Joint& joint : out_.scene.joints)
            for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
                const Dof& dof = joint.dofs[k];
                if (random) {
                    const double share = 1.2 * (double((*random)() >> 11) * 0x1p-53) - 0.1;
                    values.push_back(dof.lower + share * (dof.upper - dof.lower));
                } else {
                    values.push_back(isDriven(joint, k) ? joint.drives[k].at(time) : dof.rest);
                }
            }
        return values;
    }

    void play() {
        std::vector<std::string> warnings;
        Player player(out_.scene, warnings);
        for (const std::string& warning : warnings) // others are remarks on what was asked for
            if (warning.find("is not kept apart") != std::string::npos) trouble("{}", warning);
        for (const SkinModel& skin : out_.scene.skins) {
            SkinFigures& figures = out_.skins.emplace_back();
            figures.path = skin.path;
            figures.size = diagonal(out_.scene.bodies[skin.body].mesh);
        }
        std::mt19937_64 random(options_.seed);
        bool free = false;
        const auto step = [&](double time, bool wild) {
            const Player::Step now = player.step(asked(time, wild ? &random : nullptr), time);
            judge(now, free);
            measureSkins(player, now);
        };
        for (double time = out_.scene.startTimeCode; time <= out_.scene.endTimeCode && !stopped(); ++time)
            step(time, false);
        for (int k = 0; k < options_.steps && !stopped(); ++k) step(out_.scene.startTimeCode, true);
    }

    void judge(const Player::Step& now, bool& free) {
        std::size_t next = 0;
        for (const Joint& joint : out_.scene.joints)
            for (const Dof& dof : joint.dofs) {
                const double q = now.values[next++];
                // A file's limits are floats, those of its tables are not.
                const double rounding = std::ldexp(1, -22);
                if (!(q >= dof.lower - rounding * (1 + std::abs(dof.lower)) &&
                      q <= dof.upper + rounding * (1 + std::abs(dof.upper))))
                    trouble("{}: {} is {}, outside its limits {} to {}", joint.path, dof.name, q, dof.lower,
                            dof.upper);
            }
        if (std::isnan(now.gap)) trouble("a gap is not a number");
        if (free && !(now.gap > 0)) trouble("a free joint was led into contact, gap {}", now.gap);
        free = now.gap > 0;
        for (PairFigures& pair : out_.pairs) {
            ++pair.statuses[tss::name(now.status)];
            pair.deepest = std::min(pair.deepest, now.gap);
        }
    }

    void measureSkins(const Player& player, const Player::Step& now) {
        if (out_.skins.empty()) return;
        const std::vector<TriangleMesh> meshes = player.worldMeshes();
        for (std::size_t k = 0; k < out_.skins.size(); ++k) {
            SkinFigures& figures = out_.skins[k];
            const Body& body = out_.scene.bodies[out_.scene.skins[k].body];
            const TriangleMesh& mesh = meshes[out_.scene.skins[k].body];
            for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
                const double moved = (mesh.vertices[v] - body.placement * body.mesh.vertices[v]).norm();
                if (!(moved <= figures.size)) {
                    trouble("{}: vertex {} is {} from its place", figures.path, v, moved);
                    return;
                }
                figures.farthest = std::max(figures.farthest, moved);
            }
            figures.residual = std::max(figures.residual, now.residualDepths[k]);
        }
    }

    const std::string& name_;
    const ServeOptions& options_;
    Outcome out_;
};

bool edgesCross(const TriangleMesh& from, const TriangleMesh& other, const Pose& pose) {
    const Eigen::AlignedBox3d box = bounds(other);
    for (const Tri& t : from.triangles)
        for (int k = 0; k < 3; ++k) {
            const Vec3 p = pose * from.vertices[t[k]], way = pose * from.vertices[t[(k + 1) % 3]] - p;
            const Eigen::AlignedBox3d edge(p.cwiseMin(p + way), p.cwiseMax(p + way));
            if (box.intersects(edge) && segmentMeets(p, way, other)) return true;
        }
    return false;
}

} // namespace

Outcome serve(const std::string& text, const std::string& name, const ServeOptions& options) {
    return Journey(name, options).run(text);
}

std::vector<KernelTarget> kernelTargets() {
    std::vector<KernelTarget> targets;
    for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                      KernelTarget::Avx512, KernelTarget::Neon})
        if (available(target)) targets.push_back(target);
    return targets;
}

bool meshesCross(const TriangleMesh& a, const TriangleMesh& b, const Pose& pose) {
    return edgesCross(b, a, pose) || edgesCross(a, b, pose.inverse(Eigen::Isometry));
}

} // namespace extreme
