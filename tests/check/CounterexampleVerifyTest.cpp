// The scenes for which something false was once stated as proven, or something true refused: what `verify`
// says of them now. They are no part of this repository.
#include "bake/base/Error.h"
#include "bake/check/VerifyPair.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/Query.h"
#include "bake/verify/Kernel.h"
#include "tests/GroundTruth.h"
#include "tests/SharedMeshes.h"

#include <catch2/catch.hpp>
#include <optional>

using namespace tss;

namespace {

std::string file(const std::string& name) {
    return std::string(OSGTSS_SHARED_MESHES) + "/../counterexamples/" + name;
}

#define REQUIRE_COUNTEREXAMPLE(name)                                                                         \
    if (!std::filesystem::exists(file(name))) {                                                              \
        WARN("skipped, no " << name);                                                                        \
        return;                                                                                              \
    }

/// Where the meshes meet and the table, or the proof, says that they do not; nothing where none is found.
std::optional<std::vector<double>> missed(const SceneModel& scene, const Pair& pair) {
    const GroundTruth truth(scene.bodies[pair.bodyA].mesh, scene.bodies[pair.bodyB].mesh);
    const Motion motion = pairMotion(scene, pair);
    for (const std::vector<double>& q : randomPoses(motion, 300, 1)) {
        if (!truth.touches(pose(motion, q))) continue;
        if (!pair.table || query(*pair.table, q).gap > pair.table->boundMiss.value_or(0) + 1e-7) return q;
    }
    return std::nullopt;
}

void holdsWithEveryKernel(const std::string& name) {
    CAPTURE(name);
    const SceneModel scene = loadScene(file(name));
    const PairVerdict verdict = verifyPair(scene, scene.pairs[0]);
    INFO(verdict.reason);
    CHECK(verdict.holds());
    const TriedPoses poses = posesToTry(*scene.pairs[0].table);
    int tried = 0;
    for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                      KernelTarget::Avx512, KernelTarget::Neon})
        for (const KernelForm form : {KernelForm::Fold, KernelForm::Direct})
            for (const KernelPrecision precision : {KernelPrecision::Float, KernelPrecision::Double}) {
                if (!available(target)) continue;
                std::optional<PreparedTable> prepared;
                try {
                    prepared.emplace(*scene.pairs[0].table, PrepareOptions{target, form, precision, {}});
                } catch (const InputError&) { // no fold for this motion
                    continue;
                }
                const KernelVerdict kernel = verifyKernel(*scene.pairs[0].table, *prepared, poses);
                INFO(tss::name(target)
                     << " " << tss::name(form) << " " << tss::name(precision) << ": " << kernel.reason);
                CHECK(kernel.proven);
                ++tried;
            }
    CHECK(tried >= 2);
}

} // namespace

TEST_CASE("tables whose file says what is not so are refused with a pose") {
    for (const char* name : {"re__shrink_and_count.tss", "rn__miss0_cov0.tss"}) {
        REQUIRE_COUNTEREXAMPLE(name);
        CAPTURE(name);
        const SceneModel scene = loadScene(file(name));
        const Pair& pair = scene.pairs[0];
        const PairVerdict verdict = verifyPair(scene, pair);
        CHECK_FALSE(verdict.holds());
        REQUIRE_FALSE(verdict.pose.empty());
        const GroundTruth truth(scene.bodies[pair.bodyA].mesh, scene.bodies[pair.bodyB].mesh);
        CHECK(truth.touches(pose(pairMotion(scene, pair), verdict.pose)));
        CHECK_FALSE(query(*pair.table, verdict.pose).hit());
        CHECK(missed(scene, pair));
    }
}

TEST_CASE("honest tables of far axes and tiny ranges hold, and so do all kernels made from them") {
    for (const char* name : {"far_9_baked.tss", "off1e5_baked.tss", "t76_baked.tss", "fe1_baked.tss"}) {
        REQUIRE_COUNTEREXAMPLE(name);
        holdsWithEveryKernel(name);
    }
}
