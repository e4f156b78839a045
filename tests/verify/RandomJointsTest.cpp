#include "bake/table/Query.h"
#include "tests/verify/Baked.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

struct Tally {
    int joints = 0, meet = 0, neverMeet = 0, paths = 0, planes = 0;
    std::size_t tests = 0;
    long poses = 0, contacts = 0, missed = 0, early = 0;
};

/// The largest rounding that two ways of working out a gap may differ by, on scenes about a unit across.
constexpr double gapRounding = 1e-10;

/// A joint of 1 to 4 DOFs, some of them paths, some coupled, and two clouds of spheres.
scenes::Scene randomJoint(std::uint64_t seed) {
    const int dofs = 1 + int(seed % 4);
    scenes::Scene scene = scenes::randomScene(seed, dofs, dofs < 4 ? 40 : 14, seed % 3 == 0);
    scenes::Random random(seed ^ 0x5eedu);
    if (dofs > 1 && seed % 5 == 0) {
        LimitPlane plane{std::vector<double>(scene.motion.dofCount(), 0.0), random.in(0.05, 0.3)};
        for (double& c : plane.coefficients) c = random.in(-1, 1);
        scene.motion.planes.push_back(plane);
    }
    return scene;
}

/// At one pose, by all pairs: where the models touch the table does, and the other way round.
void look(const scenes::Scene& scene, const Table& table, const std::vector<double>& q, Tally& tally) {
    const Pose at = pose(scene.motion, q);
    const double models = queryAllPairs(scene.a, scene.b, at).gap, answer = query(table, at).gap;
    ++tally.poses;
    tally.contacts += models <= 0;
    tally.missed += models <= 0 && answer > std::max(0.0, models) + table.epsilon + gapRounding;
    tally.early += answer < models - gapRounding;
}

void checkJoint(std::uint64_t seed, int poses, Tally& tally) {
    CAPTURE(seed);
    const scenes::Scene scene = randomJoint(seed);
    const Table table = baked(scene);
    REQUIRE(table.epsilon == 0);
    const VerifyResult proof = verifyTable(scene.a, scene.b, table, scene.motion, colliding());
    INFO(proof.reason);
    CHECK(proof.proven);

    ++tally.joints;
    tally.tests += table.testCount();
    tally.planes += !scene.motion.planes.empty();
    for (const Dof& dof : scene.motion.dofs) tally.paths += dof.kind == DofKind::Path;
    ++(table.testCount() > 0 ? tally.meet : tally.neverMeet);
    scenes::Random random(seed);
    std::vector<double> free, hit;
    for (int k = 0; k < poses; ++k) {
        const auto q = scenes::randomPose(random, scene.motion);
        look(scene, table, q, tally);
        (queryAllPairs(scene.a, scene.b, pose(scene.motion, q)).gap <= 0 ? hit : free) = q;
        if (k % 10 || free.empty() || hit.empty()) continue;
        const auto [before, after] = bisected(scene, free, hit);
        look(scene, table, before, tally);
        look(scene, table, after, tally);
    }
}

void checkJoints(std::uint64_t first, int joints, int poses) {
    Tally tally;
    for (std::uint64_t seed = first; tally.joints < joints; ++seed) checkJoint(seed, poses, tally);
    WARN(tally.joints << " joints of 1 to 4 DOFs (" << tally.paths << " paths, " << tally.planes
                      << " coupled): " << tally.meet << " meet, " << tally.neverMeet << " never, "
                      << tally.tests << " tests together; " << tally.poses << " poses, " << tally.contacts
                      << " contacts, " << tally.missed << " missed, " << tally.early << " early");
    CHECK(tally.missed == 0);
    CHECK(tally.early == 0);
    CHECK(tally.meet > joints / 3);
    CHECK(tally.contacts > tally.poses / 50);
}

} // namespace

TEST_CASE("20 random joints of 1 to 4 DOFs: baked, proven, and right at every pose tried") {
    checkJoints(1, 20, 500);
}

TEST_CASE("200 random joints of 1 to 4 DOFs: baked, proven, and right at every pose tried", "[.long]") {
    checkJoints(1000, 200, 5000);
}

TEST_CASE("a pair over six joints gets the epsilon that its budget reached, and the verifier agrees") {
    int cutShort = 0, answered = 0;
    std::size_t contacts = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        CAPTURE(seed);
        const scenes::Scene scene = scenes::randomScene(seed, 6, 12, true);
        CoverOptions options;
        options.looks = 10'000'000;
        const CoverResult cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion, options);
        cutShort += !cover.complete;
        CHECK(std::isfinite(cover.epsilon) == !cover.pairs.empty()); // no contact was met in the budget
        if (cover.pairs.empty()) continue;
        ++answered;
        const Table table = tableOf(scene, cover, options);
        const VerifyResult proof = verifyTable(scene.a, scene.b, table, scene.motion, colliding());
        INFO("epsilon " << cover.epsilon << ": " << proof.reason);
        CHECK(proof.proven);
        Tally tally;
        scenes::Random random(seed);
        for (int k = 0; k < 2000; ++k) look(scene, table, scenes::randomPose(random, scene.motion), tally);
        CHECK(tally.missed == 0);
        contacts += tally.contacts;
    }
    CHECK(cutShort > 0);
    CHECK(answered > 1);
    CHECK(contacts > 0);
}
