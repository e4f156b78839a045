// The response on baked joints, judged by their full sphere models and by fine search.
#include "bake/scene/SceneFile.h"
#include "bake/search/NodePairs.h"
#include "tests/Shapes.h"
#include "tests/SharedMeshes.h"
#include "tests/respond/Walk.h"
#include "tests/tool/Shell.h"

#include <iostream>

using namespace tss;
using random_table::Random;

namespace {

/// A baked joint with all its spheres (--keep-spheres, --at-rest collide).
struct Joint {
    Table table;
    SphereTree a, b;
    explicit Joint(const std::string& file) : Joint(*loadScene(file).pairs.at(0).table) {}
    explicit Joint(const Table& baked) : table(baked), a(table.a), b(table.b) {}
    /// Of all spheres, or some gap above 0 where that is larger.
    double gap(const std::vector<double>& q) const {
        return smallestGap(a, b, pose(table.motion, q), std::numeric_limits<double>::infinity());
    }
    double tableGap(const std::vector<double>& q) const { return query(table, q).gap; }
};

struct Tally {
    int steps = 0, free = 0, blocked = 0, slid = 0;
    int collided = 0, farther = 0, wentThrough = 0; ///< none allowed
    int jumps = 0;                                  ///< asked across an obstacle
    int searched = 0, shortOf = 0;                  ///< slid steps judged by search; not at a local optimum
};

std::vector<double> freePose(const Joint& joint, Random& random) {
    for (;;) {
        std::vector<double> q =
            clampToLimits(joint.table.motion, random_table::values(random, joint.table.motion));
        if (joint.gap(q) > 0) return q;
    }
}

/// Steps of any size, tiny to the whole range; up to 10,000 ways sampled, so that none leads through.
Tally steps(const Joint& joint, int count, std::uint64_t seed) {
    const JointResponder responder(joint.table);
    JointWorkspace ws = responder.workspace();
    Random random(seed);
    Tally tally;
    const auto gapAt = [&](const std::vector<double>& q) { return joint.gap(q); };
    std::vector<double> q = freePose(joint, random);
    for (; tally.steps < count; ++tally.steps) {
        if (tally.steps % 1000 == 0) q = freePose(joint, random);
        const std::vector<double> asked = walk::askedPose(random, joint.table.motion, q);
        const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
        const std::vector<double> next(answer.q.begin(), answer.q.begin() + q.size());
        tally.collided += !(joint.gap(next) > 0);
        tally.farther += walk::distance(responder, next, asked) > walk::distance(responder, q, asked);
        tally.free += answer.status == JointStatus::Free;
        tally.blocked += answer.status == JointStatus::Blocked;
        tally.slid += answer.status == JointStatus::Slid;
        if (tally.steps % std::max(10, count / 10000) == 0) {
            const bool across = joint.gap(asked) > 0 && walk::smallestGapBetween(q, asked, 100, gapAt) <= 0;
            tally.jumps += across;
            const bool straight = answer.status == JointStatus::Free;
            tally.wentThrough += straight && (across || next != asked);
        }
        q = next;
    }
    return tally;
}

/// Small steps towards one pose in collision after another, those that met something judged by a fine search.
void slides(const Joint& joint, int count, std::uint64_t seed, Tally& tally) {
    const JointResponder responder(joint.table);
    JointWorkspace ws = responder.workspace();
    Random random(seed);
    std::vector<double> q = freePose(joint, random), hand = q;
    for (int step = 0; tally.searched < count && step < 1000 * count; ++step) {
        if (step % 60 == 0) do
                hand = clampToLimits(joint.table.motion, random_table::values(random, joint.table.motion));
            while (joint.tableGap(hand) > 0);
        std::vector<double> asked = q;
        for (std::size_t k = 0; k < q.size(); ++k) asked[k] += 0.05 * (hand[k] - q[k]);
        const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
        std::copy_n(answer.q.begin(), q.size(), q.begin());
        if (answer.status == JointStatus::Free) continue;
        ++tally.searched;
        tally.shortOf += walk::nearerBy(joint.table, responder, q, asked, random) > 1e-3;
    }
}

struct Starts {
    int known = 0, knownOut = 0; ///< within the table's depth; out after one response
    int deep = 0, deepOut = 0;   ///< deeper; out in the end
    int fellBack = 0;            ///< in collision again after they were out
};

/// Starts in collision, held there by a hand.
Starts starts(const Joint& joint, int count, std::uint64_t seed) {
    const JointResponder responder(joint.table);
    JointWorkspace ws = responder.workspace();
    Random random(seed);
    Starts found;
    for (int tries = 0; found.known + found.deep < count && tries < 1000 * count; ++tries) {
        // Half of them just inside, from a free pose.
        std::vector<double> q =
            clampToLimits(joint.table.motion, random_table::values(random, joint.table.motion));
        if (joint.tableGap(q) > 0) continue;
        if (tries % 2) {
            std::vector<double> out = freePose(joint, random);
            for (int cut = 0; cut < 12; ++cut) {
                std::vector<double> middle = q;
                for (std::size_t k = 0; k < q.size(); ++k) middle[k] = 0.5 * (q[k] + out[k]);
                (joint.tableGap(middle) > 0 ? out : q) = middle;
                if (joint.tableGap(q) > -joint.table.gapDepth) break;
            }
        }
        const bool known = joint.tableGap(q) > -joint.table.gapDepth;
        const std::vector<double> asked = q;
        int frames = 0;
        for (; frames < 1000 && !(joint.tableGap(q) > 0); ++frames) {
            const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
            std::copy_n(answer.q.begin(), q.size(), q.begin());
        }
        const bool out = joint.gap(q) > 0;
        if (known) {
            ++found.known;
            found.knownOut += out && frames <= 1;
        } else {
            ++found.deep;
            found.deepOut += out;
        }
        for (int stay = 0; stay < 5 && out; ++stay) {
            const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
            std::copy_n(answer.q.begin(), q.size(), q.begin());
            found.fellBack += !(joint.gap(q) > 0);
        }
    }
    return found;
}

void judge(const std::string& name, const Joint& joint, int count) {
    Tally tally = steps(joint, count, 1);
    slides(joint, count / 500, 2, tally);
    const Starts in = starts(joint, count / 500, 3);
    std::cout << name << ": " << tally.steps << " steps, " << tally.free << " free, " << tally.blocked
              << " blocked, " << tally.slid << " slid; " << tally.collided << " in collision, "
              << tally.farther << " farther; " << tally.jumps << " jumps across looked at, "
              << tally.wentThrough << " went through; " << tally.searched << " slides searched, "
              << tally.shortOf << " short of the optimum; starts inside: " << in.knownOut << " of "
              << in.known << " out at once, deeper " << in.deepOut << " of " << in.deep << " out in the end, "
              << in.fellBack << " fell back\n";
    CHECK(tally.collided == 0);
    CHECK(tally.farther == 0);
    CHECK(tally.wentThrough == 0);
    CHECK(tally.jumps > 0);
    CHECK(tally.slid + tally.blocked > count / 100);
    CHECK(tally.searched == count / 500);
    CHECK(tally.shortOf <= tally.searched / 100);
    CHECK(in.known > 0);
    CHECK(in.knownOut >= 0.99 * in.known);
    CHECK(in.deepOut == in.deep);
    CHECK(in.fellBack == 0);
}

void bakeAndJudge(const std::string& name, const std::string& make, const std::string& bake, int count) {
    const Folder folder;
    const Ran made = runTss("make -o s.tss " + make, folder.path());
    INFO(made.err);
    REQUIRE(made.exit == 0);
    const Ran baked =
        runTss("bake s.tss -o b.tss --at-rest collide --keep-spheres --quiet " + bake, folder.path());
    INFO(baked.err);
    REQUIRE(baked.exit == 0);
    judge(name, Joint(folder / "b.tss"), count);
}

std::string mesh(const std::string& option, const std::string& file) {
    return " --" + option + " '" + sharedMesh(file) + "'";
}

void judgeDogJaw(int count) {
    bakeAndJudge("dog jaw",
                 mesh("a", "dog_jaw/skull.obj") + mesh("b", "dog_jaw/mandible.obj") +
                     " --meters-per-unit 1 --dof rot:0.30549,0,0.68499:0,0,1:-4:4 --dof "
                     "rot:0.30549,0,0.68499:0,1,0:-24:18 --b-offset=-0.001,0,-0.002",
                 "--tolerance 0.4mm --depth 0.5mm", count);
}

} // namespace

TEST_CASE("the response keeps a real jaw out of collision, on its way and to the nearest pose") {
    REQUIRE_SHARED_MESHES();
    judgeDogJaw(20000);
}

TEST_CASE("a million random steps keep a dog's jaw out of collision", "[.long]") {
    REQUIRE_SHARED_MESHES();
    judgeDogJaw(1000000);
}

TEST_CASE("a million random steps keep a dog's shoulder out of collision", "[.long]") {
    REQUIRE_SHARED_MESHES();
    bakeAndJudge("dog shoulder",
                 mesh("a", "dog_limbs/scapula_L.obj") + mesh("b", "dog_limbs/humerus_L.obj") +
                     " --meters-per-unit 1 --dof rot:0.1954,0.053,0.42522:0,1,0:-40:60 --dof "
                     "rot:0.1954,0.053,0.42522:-1,0,1:-30:15",
                 "--tolerance 0.4mm --depth 0.5mm", 1000000);
}

TEST_CASE("a million random steps keep human teeth out of collision", "[.long]") {
    REQUIRE_SHARED_MESHES();
    bakeAndJudge("human teeth",
                 mesh("a", "human_jaw_ict/upper_teeth.obj") + mesh("b", "human_jaw_ict/lower_teeth.obj") +
                     " --meters-per-unit 0.01 --dof rot:0,-0.547,1.819:1,0,0:0:25.3 --dof "
                     "rot:0,0,-10.3:0,1,0:-1.89:1.89 --dof trans:0,-0.17,0.888:0:1",
                 "--tolerance 0.2mm --depth 0.5mm", 1000000);
}

TEST_CASE("bodies that are free only where two values go together are told of a path") {
    const Folder folder;
    TriangleMesh rack = boxMesh({-1.5, -0.1, -0.1}, {-0.515, 0.1, 0.1});
    const TriangleMesh other = boxMesh({0.515, -0.1, -0.1}, {1.5, 0.1, 0.1});
    for (const Tri& t : other.triangles) rack.triangles.push_back(t + Tri::Constant(8));
    rack.vertices.insert(rack.vertices.end(), other.vertices.begin(), other.vertices.end());
    writeObj(rack, folder / "rack.obj");
    writeObj(boxMesh({-0.5, -0.12, -0.12}, {0.5, 0.12, 0.12}), folder / "tooth.obj");
    // The sum of both moves the tooth: the one goes back as far as the other goes on.
    REQUIRE(runTss("make -o in.tss --a rack.obj --b tooth.obj --dof trans:1,0,0:-0.5:0.5 "
                   "--dof trans:1,0,0:-1.5:1.5",
                   folder.path())
                .exit == 0);
    const Ran ran = runTss("bake in.tss -o baked.tss --tolerance 0.006", folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    INFO(ran.out);
    CHECK(ran.out.find("  held  ") != std::string::npos);
    CHECK(ran.out.find("let a path say so (tss make --dof path)") != std::string::npos);
    CHECK(ran.out.find("let a path say so (--dof path)") != std::string::npos); // beside where it may rest
}
