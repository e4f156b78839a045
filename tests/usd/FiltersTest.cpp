#include "tests/usd/Stages.h"

#include <catch2/catch.hpp>

#include <set>

using namespace tss;

namespace {

/// A ball that hangs on the body a by a hinge, of colliders c and d, at x = 8 k.
std::string filteredBody(const std::string& name, int k) {
    const std::string at = std::to_string(8 * k);
    return "def Xform \"" + name +
           "\" ( prepend apiSchemas = [\"PhysicsRigidBodyAPI\"] ) {\n"
           "double3 xformOp:translate = (" +
           at +
           ", 0, 0)\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n"
           "def Cube \"c\" ( prepend apiSchemas = [\"PhysicsCollisionAPI\"] ) {}\n"
           "def Xform \"d\" ( prepend apiSchemas = [\"PhysicsCollisionAPI\"] ) { def Sphere \"s\" {} }\n"
           "def PhysicsRevoluteJoint \"j\" { rel physics:body0 = </R/a>\nrel physics:body1 = </R/" +
           name + ">\npoint3f physics:localPos0 = (" + at + ", 0, 0)\n" +
           "float physics:lowerLimit = -5\nfloat physics:upperLimit = 5 } }\n";
}

/// Bodies a to d, b to d on a, and what is said of their pairs.
RobotScene filteredScene(const std::string& said) {
    return robotScene("( defaultPrim = \"R\"\n metersPerUnit = 0.01 )\ndef Xform \"R\" {\n"
                      "def Xform \"a\" ( prepend apiSchemas = [\"PhysicsRigidBodyAPI\"] ) {\n"
                      "def Cube \"c\" ( prepend apiSchemas = [\"PhysicsCollisionAPI\"] ) {} }\n" +
                      filteredBody("b", 1) + filteredBody("c", 2) + filteredBody("d", 3) + said + "}\n");
}

std::string collisionGroup(const std::string& name, const std::string& includes, const std::string& filtered,
                           const std::string& more = "") {
    return "def PhysicsCollisionGroup \"" + name +
           "\" ( prepend apiSchemas = [\"CollectionAPI:colliders\"] ) {\n"
           "prepend rel collection:colliders:includes = [" +
           includes + "]\nprepend rel physics:filteredGroups = [" + filtered + "]\n" + more + "}\n";
}

/// The pairs that are left, as in "ab ac bc", from bodies' names of one letter.
std::string pairsOf(const RobotScene& made) {
    std::set<std::string> names;
    for (const Pair& pair : made.scene.pairs) {
        const std::string &a = made.scene.bodies[pair.bodyA].path, &b = made.scene.bodies[pair.bodyB].path;
        names.insert(std::min(a.back(), b.back()) + std::string(1, std::max(a.back(), b.back())));
    }
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : " ") + name;
    return all;
}

const std::string allPairs = "ab ac ad bc bd cd";

} // namespace

TEST_CASE("collision groups that filter each other, or themselves, leave no pair of their bodies") {
    CHECK(pairsOf(filteredScene("")) == allPairs);
    const std::string one = collisionGroup("G", "</R/b>, </R/c>", "</R/H>"),
                      other = collisionGroup("H", "</R/d>", "");
    const RobotScene both = filteredScene(one + other);
    CHECK(pairsOf(both) == "ab ac ad bc");
    CHECK(hasNote(both.notes, "the robot's files switch off, left out: 2"));
    CHECK(!hasNote(both.notes, "PhysicsCollisionGroup"));
    CHECK(pairsOf(filteredScene(collisionGroup("G", "</R/b>, </R/c>", "</R/G>"))) == "ab ac ad bd cd");
    CHECK(pairsOf(filteredScene(collisionGroup("G", "</R/b>, </R/c>", "</R/none>"))) == allPairs);
}

TEST_CASE("inverted collision groups filter the groups that they do not name, merged ones are one") {
    const std::string invert = "bool physics:invertFilteredGroups = 1\n";
    const std::string others = collisionGroup("H", "</R/c>", "") + collisionGroup("I", "</R/d>", "");
    CHECK(pairsOf(filteredScene(collisionGroup("G", "</R/b>", "</R/H>", invert) + others)) ==
          "ab ac ad bc cd"); // a is in no group
    const std::string merged = "string physics:mergeGroup = \"m\"\n";
    CHECK(pairsOf(filteredScene(collisionGroup("G", "</R/b>", "</R/I>", merged) +
                                collisionGroup("H", "</R/c>", "", merged) +
                                collisionGroup("I", "</R/d>", ""))) == "ab ac ad bc");
}

TEST_CASE("a body is filtered where all of its colliders are, by the nearest that a collection names") {
    const auto groups = [](const std::string& includes, const std::string& more = "") {
        return filteredScene(collisionGroup("G", includes, "</R/H>", more) +
                             collisionGroup("H", "</R/c>", ""));
    };
    const RobotScene some = groups("</R/b/c>");
    CHECK(pairsOf(some) == allPairs);
    CHECK(hasNote(some.notes, "some shapes alone are filtered, so that their pair stays on: b and c"));
    CHECK(pairsOf(groups("</R/b/c>, </R/b/d>")) == "ab ac ad bd cd");
    CHECK(pairsOf(groups("</R/b>", "rel collection:colliders:excludes = </R/b/d>\n")) == allPairs);
    CHECK(
        pairsOf(groups("</R/b>", "uniform token collection:colliders:expansionRule = \"explicitOnly\"\n")) ==
        allPairs);
    CHECK(pairsOf(groups("</R/b/c>, </R/b/d>",
                         "uniform token collection:colliders:expansionRule = \"explicitOnly\"\n")) ==
          "ab ac ad bd cd");
    CHECK(pairsOf(groups("", "bool collection:colliders:includeRoot = 1\n"
                             "rel collection:colliders:excludes = [</R/a>, </R/c>]\n")) == "ab ac ad bd");
}

TEST_CASE("what is not read of a collision group leaves pairs on, by name") {
    const RobotScene other =
        filteredScene(collisionGroup("G", "</R/b>, </R/c>", "</R/G>",
                                     "rel collection:colliders:excludes = </R/H.collection:colliders>\n"));
    CHECK(pairsOf(other) == allPairs);
    CHECK(hasNote(other.notes, "that other collections or expressions name: /R/G"));
    const RobotScene wrong = filteredScene(
        collisionGroup("G", "</R/b>, </R/c>", "</R/G>", "string physics:invertFilteredGroups = \"x\"\n"));
    CHECK(pairsOf(wrong) == allPairs);
    CHECK(hasNote(wrong.notes, "collision groups that cannot be read: /R/G (physics:invertFilteredGroups"));
}

TEST_CASE("filtered pairs may be of colliders, or of a body and the colliders of another") {
    const auto filtered = [](const std::string& named) { // by the one collider of a
        std::string text = "def Xform \"R\" {\ndef Xform \"a\" ( prepend apiSchemas = "
                           "[\"PhysicsRigidBodyAPI\"] ) {\ndef Cube \"c\" ( prepend apiSchemas = "
                           "[\"PhysicsCollisionAPI\", \"PhysicsFilteredPairsAPI\"] ) {\n"
                           "rel physics:filteredPairs = [" +
                           named + "] } }\n";
        return robotScene("( metersPerUnit = 0.01 )\n" + text + filteredBody("b", 1) + "}\n");
    };
    CHECK(pairsOf(filtered("")) == "ab");
    CHECK(pairsOf(filtered("</R/b>")).empty());
    CHECK(pairsOf(filtered("</R/b/c>, </R/b/d/s>")).empty());
    const RobotScene some = filtered("</R/b/d>");
    CHECK(pairsOf(some) == "ab");
    CHECK(hasNote(some.notes, "so that their pair stays on: a and b"));
    const RobotScene none = filtered("</R/b/j>");
    CHECK(pairsOf(none) == "ab");
    CHECK(hasNote(none.notes, "not of bodies or colliders, so that they stay on: /R/a/c"));
}
