// `tss make` of several bodies, joints, muscles and a skin.
#include "bake/scene/SceneFile.h"
#include "tests/tool/Swing.h"

#include <nlohmann/json.hpp>

using Json = nlohmann::json;

namespace {

/// Three bones in a row, a long muscle between the first two, a ball around all.
void writeLimb(const Folder& folder) {
    writeObj(boxMesh({0, -0.2, -0.2}, {2, 0.2, 0.2}), folder / "upper.obj");
    writeObj(boxMesh({2.1, -0.2, -0.2}, {4, 0.2, 0.2}), folder / "lower.obj");
    writeObj(boxMesh({4.1, -0.2, -0.2}, {5, 0.2, 0.2}), folder / "foot.obj");
    tss::TriangleMesh muscle = ballMesh({0, 0, 0}, 1, 3);
    for (tss::Vec3& v : muscle.vertices)
        v = tss::Vec3(2, 0, 0.6) + v.cwiseProduct(tss::Vec3(1.6, 0.25, 0.25));
    writeObj(muscle, folder / "calf.obj");
    writeObj(ballMesh({2.5, 0, 0}, 3, 3), folder / "hide.obj");
}

const std::string limb = "--body upper.obj --body shank=lower.obj --body foot.obj "
                         "--joint 'knee=upper,shank:rot:2.05,0,0:0,1,0:-10:60' "
                         "--joint 'ankle=shank,foot:rot:4.05,0,0:0,1,0:-20:20;rot:4.05,0,0:0,0,1:-5:5' ";

} // namespace

TEST_CASE("bodies, joints, a muscle and a skin are a scene that moves") {
    const Folder folder;
    writeLimb(folder);
    const Ran ran = runTss("make -o limb.tss " + limb +
                               "--muscle calf.obj,from=upper,contract=0.3 --skin hide.obj --json",
                           folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    CHECK(Json::parse(ran.out)["pairs"].size() == 3);
    CHECK(ran.err.find("44 % of the muscle calf lie nearer to shank than to upper") != std::string::npos);
    const tss::SceneModel scene = tss::loadScene(folder / "limb.tss");
    CHECK(scene.endTimeCode == 4 * 48); // three values and a muscle, two seconds each
    REQUIRE(scene.joints.size() == 2);
    CHECK(scene.joints[1].dofs.size() == 2);
    REQUIRE(scene.muscles.size() == 1);
    const tss::MuscleModel& muscle = scene.muscles[0];
    CHECK(scene.bodies[muscle.bone].path == "/limb/upper");
    CHECK(muscle.muscle.fibre.front().x() ==
          Approx(0.4).margin(1e-6)); // the end near the bone it is from stays
    CHECK(muscle.muscle.fibre.back().x() == Approx(3.6).margin(0.02));
    CHECK(muscle.muscle.maxContraction == Approx(0.3));
    REQUIRE(scene.skins.size() == 1);
    CHECK(scene.skins[0].bones.size() == 3);
    CHECK(scene.skins[0].muscles.size() == 1);
    CHECK(runTss("validate limb.tss", folder.path()).exit == 0);

    const Ran over =
        runTss("make -o over.tss " + limb + "--muscle calf.obj,from=upper,to=foot --json", folder.path());
    CHECK(over.exit == 0);
    CHECK(over.err.find("calf: a tube") != std::string::npos);
    CHECK(over.err.find("(on foot) past shank, shortens") != std::string::npos);
    CHECK(over.err.find("lie nearer") == std::string::npos);

    REQUIRE(
        runTss("make -o some.tss " + limb + "--skin hide.obj --bone shank --pairs neighbours", folder.path())
            .exit == 0);
    const tss::SceneModel some = tss::loadScene(folder / "some.tss");
    CHECK(some.pairs.size() == 2);
    REQUIRE(some.skins[0].bones.size() == 1);
    CHECK(some.bodies[some.skins[0].bones[0]].path == "/some/shank");
}

TEST_CASE("a body that no joint moves stands still, and what moves is paired with it too") {
    const Folder folder;
    writeLimb(folder);
    const Ran ran = runTss("make -o limb.tss --body upper.obj --body shank=lower.obj --body foot.obj "
                           "--joint 'knee=upper,shank:rot:2.05,0,0:0,1,0:-10:60' --skin hide.obj",
                           folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    CHECK((ran.out + ran.err).find("fixed: foot_still") != std::string::npos);
    const tss::SceneModel scene = tss::loadScene(folder / "limb.tss");
    REQUIRE(scene.pairs.size() == 2);
    for (const tss::Pair& pair : scene.pairs) {
        const int shank = scene.bodies[pair.bodyA].path == "/limb/shank" ? pair.bodyA : pair.bodyB;
        CHECK(scene.bodies[shank].path == "/limb/shank");
    }
}

TEST_CASE("a muscle from one body to another lies between both") {
    const Folder folder;
    writeLimb(folder);
    const Ran ran = runTss("make -o limb.tss " + limb +
                               "--muscle calf.obj,from=upper,to=shank,contract=0.3 --skin hide.obj",
                           folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    CHECK(ran.err.find("of the muscle calf lie nearer") == std::string::npos);
    const tss::SceneModel scene = tss::loadScene(folder / "limb.tss");
    const tss::MuscleModel& muscle = scene.muscles.at(0);
    CHECK(scene.bodies[muscle.bone].path == "/limb/upper");
    REQUIRE(muscle.insertionBone >= 0);
    CHECK(scene.bodies[muscle.insertionBone].path == "/limb/shank");
    CHECK(muscle.muscle.spans);
    const Ran played = runTss("play limb.tss -o limb.csv", folder.path());
    INFO(played.err);
    CHECK(played.exit == 0);
}

TEST_CASE("of muscles that cannot do what is asked, make, validate and bake say it") {
    const Folder folder;
    writeLimb(folder);
    // Winding: most of a circle. Open: without one triangle.
    tss::TriangleMesh winding = ballMesh({0, 0, 0}, 1, 4);
    for (tss::Vec3& v : winding.vertices) {
        const double angle = 0.9 * M_PI * v.x(), away = 2 - 0.2 * v.y();
        v = {away * std::cos(angle), away * std::sin(angle), 0.2 * v.z()};
    }
    writeObj(winding, folder / "winding.obj");
    const auto says = [&](const std::string& muscle, const std::string& words) {
        const Ran ran = runTss("make -o m.tss " + limb + "--muscle " + muscle + ",from=upper", folder.path());
        INFO(ran.out << ran.err);
        CHECK(ran.exit == 0);
        CHECK(ran.out.find(words) != std::string::npos);
    };
    for (tss::Tri& t : winding.triangles) std::swap(t[1], t[2]);
    writeObj(winding, folder / "inwards.obj");
    says("inwards.obj", "inwards is flat or inside out");
    says("winding.obj", "winding winds round so far");
    tss::TriangleMesh open = ballMesh({0, 0, 2}, 1, 2);
    open.triangles.pop_back();
    writeObj(open, folder / "nearly.obj");
    says("nearly.obj", "count as closed by flat fans");
    CHECK(runTss("validate m.tss", folder.path()).exit == 0);
    open.triangles.resize(open.triangles.size() / 2);
    writeObj(open, folder / "open.obj");
    says("open.obj", "open is not closed");
    const Ran invalid = runTss("validate m.tss", folder.path()); // also where it lies under no skin
    CHECK(invalid.exit == 1);
    CHECK(invalid.out.find("closed") + invalid.err.find("closed") != 2 * std::string::npos);

    // A sheet whose bones are pushed together by nearly its whole length has nowhere to go.
    tss::TriangleMesh sheet = ballMesh({0, 0, 0}, 1, 4);
    for (tss::Vec3& v : sheet.vertices)
        v = tss::Vec3(2.05, 0, 0.3) + v.cwiseProduct(tss::Vec3(1.8, 0.8, 0.04));
    writeObj(sheet, folder / "sheet.obj");
    const Ran made = runTss("make -o s.tss --body upper.obj --body lower.obj --joint "
                            "'knee=upper,lower:trans:1,0,0:-3.3:0' --skin hide.obj "
                            "--muscle sheet.obj,from=upper,to=lower,sheet",
                            folder.path());
    INFO(made.err);
    REQUIRE(made.exit == 0);
    const Ran baked = runTss("bake s.tss -o b.tss --tolerance 0.1 --budget 1", folder.path());
    INFO(baked.out << baked.err);
    REQUIRE(baked.exit == 0);
    CHECK(baked.out.find("sheet cannot keep its volume") != std::string::npos);
}

TEST_CASE("the same hinge is the same motion whichever way it is made") {
    const Folder folder;
    writeLimb(folder);
    const std::string dof = "rot:2.05,0,0.1:0,1,1:-10:60";
    REQUIRE(runTss("make -o one.tss --a upper.obj --b lower.obj --dof " + dof, folder.path()).exit == 0);
    REQUIRE(runTss("make -o two.tss --body upper.obj --body lower.obj --joint 'knee=upper,lower:" + dof + "'",
                   folder.path())
                .exit == 0);
    const tss::SceneModel one = tss::loadScene(folder / "one.tss"), two = tss::loadScene(folder / "two.tss");
    const tss::Motion a = pairMotion(one, one.pairs.at(0)), b = pairMotion(two, two.pairs.at(0));
    for (double angle : {-0.17, 0.0, 0.5, 1.0})
        CHECK((pose(a, std::vector{angle}).matrix() - pose(b, std::vector{angle}).matrix()).norm() < 1e-6);
}

TEST_CASE("values of one kind have names of their own") {
    const Folder folder;
    writeLimb(folder);
    REQUIRE(runTss("make -o ankle.tss --a lower.obj --b foot.obj --dof rot:4.05,0,0:0,1,0:-20:20 "
                   "--dof trans:0,0,0.5:0:0.1 --dof rot:4.05,0,0:0,0,1:-5:5 --meters-per-unit 0.01",
                   folder.path())
                .exit == 0);
    const Json info = Json::parse(runTss("info ankle.tss --json", folder.path()).out);
    const std::string joint = info["pairs"][0]["joint"];
    INFO(joint);
    CHECK(joint.find("rot1 -20 to 20 degrees") != std::string::npos);
    CHECK(joint.find("rot2 -5 to 5 degrees") != std::string::npos);
    CHECK(joint.find("trans 0 to 0.1 times 5 mm") != std::string::npos);
}

TEST_CASE("what cannot be is remarked upon, and what is wrong is refused with the option") {
    const Folder folder;
    writeLimb(folder);
    writeObj(boxMesh({90, 90, 90}, {92, 91, 91}), folder / "far.obj");
    writeObj(boxMesh({0, 0, 0}, {4000, 400, 400}), folder / "huge.obj");
    const auto noted = [&](const std::string& arguments, const std::string& words) {
        const Ran ran = runTss("make -o out.tss " + arguments, folder.path());
        INFO(ran.out << ran.err);
        CHECK(ran.exit == 0);
        CHECK(ran.out.find(words) != std::string::npos);
    };
    noted(limb + "--body far.obj --skin hide.obj", "nowhere near /out/far");
    noted(limb + "--muscle far.obj --skin hide.obj", "lies outside of the skin");
    noted(limb + "--body huge.obj", "in the same unit?");
    std::filesystem::remove(folder.path() / "out.tss");
    const auto refused = [&](const std::string& arguments, int exit, const std::string& words) {
        const Ran ran = runTss("make -o out.tss " + arguments, folder.path());
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.exit == exit);
        CHECK(ran.err.find(words) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(folder.path() / "out.tss"));
    };
    refused("--body none.obj", 1, "none.obj");
    refused("--body upper.obj --body upper.obj", 1, "another body is called upper");
    refused(limb + "--joint hip", 1, "expected NAME=PARENT,CHILD:DOF");
    refused(limb + "--joint 'hip=upper,nobody:trans:1,0,0:0:1'", 1, "expected one of upper, shank, foot");
    refused(limb + "--joint 'again=upper,foot:trans:1,0,0:0:1'", 1,
            "hangs on joint ankle too; expected each link to be the child of one joint: of a closed loop "
            "leave one");
    refused(limb + "--joint 'ankle=upper,foot:trans:1,0,0:0:1'", 1, "another joint is called ankle");
    refused(limb + "--joint 'loop=foot,upper:trans:1,0,0:0:1'", 1, "loop");
    refused(limb + "--muscle calf.obj,from=nobody", 1, "no body is called \"nobody\"");
    refused(limb + "--muscle calf.obj,contract=2", 1, "between 0 and 1");
    refused(limb + "--muscle calf.obj,strong", 1, "found \"strong\"");
    refused(limb + "--bone upper", 2, "--skin");
    refused(limb + "--a upper.obj", 2, "--a");
}
