// Damages to baked tables, with the meshes as judge: what the verifier lets pass keeps what it says.
#include "bake/check/VerifyPair.h"
#include "bake/pipeline/Bake.h"
#include "bake/table/Query.h"
#include "tests/GroundTruth.h"
#include "tests/check/Damages.h"
#include "tests/pipeline/LumpyPair.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

struct Baked {
    SceneModel scene;
    Motion motion;
    double length = 0;
};

/// Two lumpy balls, one swung into the other, and for odd seeds lifted too.
Baked bakedPair(std::uint64_t seed, const BakeSettings& settings) {
    Baked baked;
    baked.scene = lumpyPair(seed);
    if (seed % 2) {
        Motion motion = swing();
        motion.dofs.push_back(joints::slide({0, 0, 1}, -0.4, 0.4));
        baked.scene.joints.clear();
        baked.scene.pairs.clear();
        addPair(baked.scene, 0, 1, motion, "Swing");
    }
    Pair& pair = baked.scene.pairs[0];
    pair.settings = settings;
    pair.settings["tolerance"] = "0.05";
    baked.length = 0.05;
    bake(baked.scene, {});
    baked.motion = pairMotion(baked.scene, pair);
    return baked;
}

struct Judged {
    int touching = 0, missed = 0, early = 0;
};

/// What the meshes say at poses spread over Q and near contact.
class Judge {
public:
    explicit Judge(const Baked& baked)
        : motion_(baked.motion), truth_(baked.scene.bodies[0].mesh, baked.scene.bodies[1].mesh),
          poses_(randomPoses(motion_, 150, 1)) {
        const auto near = nearContactPoses(truth_, motion_, 150, 1e-6, 2);
        poses_.insert(poses_.end(), near.begin(), near.end());
        for (const std::vector<double>& q : poses_) touches_.push_back(truth_.touches(pose(motion_, q)));
    }

    Judged operator()(const Table& table) const {
        constexpr double rounding = 1e-7;
        Judged judged;
        for (std::size_t k = 0; k < poses_.size(); ++k) {
            const Pose at = pose(motion_, poses_[k]);
            const double gap = query(table, at).gap;
            judged.touching += touches_[k];
            judged.missed += touches_[k] && table.boundMiss && gap > *table.boundMiss + rounding;
            judged.early += !touches_[k] && table.boundEarly && gap <= -rounding &&
                            truth_.distance(at) > *table.boundEarly + rounding;
        }
        return judged;
    }

private:
    Motion motion_;
    GroundTruth truth_;
    std::vector<std::vector<double>> poses_;
    std::vector<char> touches_;
};

struct Tally {
    int tried = 0, refused = 0, harmful = 0;
};

void damageAll(const Baked& baked, std::uint64_t seed, Tally& tally) {
    const Pair& pair = baked.scene.pairs[0];
    const Table& table = *pair.table;
    const Judge judge(baked);
    CHECK(judge(table).missed == 0);
    CHECK(judge(table).early == 0);
    std::mt19937_64 random(seed);
    for (const damages::Damage& damage : damages::kinds(baked.length)) {
        CAPTURE(damage.name);
        Table damaged = table;
        damage.apply(damaged, random);
        const MeshVerdict verdict =
            verifyOnMeshes(baked.scene.bodies[0].mesh, baked.scene.bodies[1].mesh, damaged, baked.motion);
        const Judged judged = judge(damaged);
        const bool harmful = judged.missed + judged.early > 0;
        ++tally.tried;
        tally.harmful += harmful;
        tally.refused += !verdict.holds();
        INFO(judged.missed << " of " << judged.touching << " contacts missed, " << judged.early << " early");
        if (verdict.holds()) CHECK_FALSE(harmful);
    }
}

const std::vector<BakeSettings> kindsOfBake = {{{"at-rest", "collide"}},
                                               {{"at-rest", "collide"}, {"keep-spheres", "true"}},
                                               {{"at-rest", "collide"}, {"epsilon", "0.03"}},
                                               {{"at-rest", "collide"}, {"depth", "0.1"}}};

void checkDamages(std::uint64_t first, std::uint64_t last) {
    Tally tally;
    for (std::uint64_t seed = first; seed <= last; ++seed) {
        CAPTURE(seed);
        const Baked baked = bakedPair(seed, kindsOfBake[seed % kindsOfBake.size()]);
        REQUIRE(baked.scene.pairs[0].table);
        const PairVerdict honest = verifyPair(baked.scene, baked.scene.pairs[0]);
        INFO(honest.reason);
        CHECK(honest.holds());
        damageAll(baked, seed, tally);
    }
    WARN(tally.tried << " damages: " << tally.refused << " refused, " << tally.harmful
                     << " shown harmful by the meshes, none of those passed unless said above");
    CHECK(tally.harmful > tally.tried / 8);
    CHECK(tally.refused >= tally.harmful);
}

} // namespace

TEST_CASE("no damaged table passes that misses what it says it does not: fifty kinds on four tables") {
    CHECK(damages::kinds(0.05).size() >= 50);
    checkDamages(1, 4);
}

TEST_CASE("no damaged table passes that misses what it says it does not: fifty kinds on twenty tables",
          "[.long]") {
    checkDamages(1, 20);
}
