#include "Files.h"
#include "Heard.h"
#include "Nodes.h"

#include "examples/tank/Tank.h"

#include "bake/model/Kinematics.h"

#include <catch2/catch.hpp>
#include <osgSim/DOFTransform>
#include <osgTSS/Bake>
#include <osgTSS/JointCallback>

#include <set>

using namespace files;

namespace {

/// Pairs that something is done for, over all callbacks of a graph.
class CountPairs : public osg::NodeVisitor {
public:
    CountPairs() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Node& node) override {
        for (osg::Callback* callback = node.getUpdateCallback(); callback;
             callback = callback->getNestedCallback())
            if (auto* joint = dynamic_cast<osgTSS::JointCallback*>(callback))
                pairs.insert(joint->getPairPaths().begin(), joint->getPairPaths().end());
        traverse(node);
    }
    std::multiset<std::string> pairs;
};

std::filesystem::path saveTank() {
    usePlugins();
    const auto file = scratch() / "tank.osgt";
    REQUIRE(osgDB::writeNodeFile(*makeTank(), file.string()));
    std::filesystem::remove(file.string() + ".cache.tss");
    return file;
}

/// The lowest that the gun's muzzle comes above the stowage's top while it is over the rear deck.
double lowestOverStowage(osg::Node& tank, unsigned int frames) {
    auto* gun = find<osgSim::DOFTransform>(tank, "Gun");
    REQUIRE(gun);
    Playback playback;
    double lowest = 1e9;
    for (unsigned int frame = 0; frame < frames; ++frame) {
        playback.frame(tank, frame);
        for (double along = 0; along <= 3.2; along += 0.05) {
            const osg::Vec3d point = osg::Vec3d(1.4 + along, 0, 1.75) * gun->getWorldMatrices().at(0);
            if (std::abs(point.x() + 2.4) < 0.5 && std::abs(point.y()) < 0.8)
                lowest = std::min(lowest, point.z() - (1.45 + 0.275));
        }
    }
    return lowest;
}

} // namespace

TEST_CASE("any OSG file with joints is extracted, baked and kept apart by asking for FILE.tss") {
    const auto file = saveTank();
    const osg::ref_ptr<osg::Node> plain = osgDB::readRefNodeFile(file.string());
    const osg::ref_ptr<osg::Node> apart = load(file.string() + ".tss", "pairs=all tolerance=4cm");
    REQUIRE(apart);
    constexpr unsigned int frames = 24 * 24;
    const double radius = 0.09, before = lowestOverStowage(*plain, frames);
    CHECK(before < 0); // or there would be nothing to do
    CHECK(lowestOverStowage(*apart, frames) > radius - 1e-3);

    // Nothing is installed for the pairs that are proven never to meet.
    const osgTSS::Scene* scene = osgTSS::Scene::on(*apart);
    REQUIRE(scene);
    REQUIRE(scene->getModel().pairs.size() == 3);
    std::multiset<std::string> tables;
    for (const tss::Pair& pair : scene->getModel().pairs)
        if (pair.table)
            tables.insert(pair.path);
        else
            CHECK(pair.proof);
    CHECK(tables.size() == 1);
    CountPairs count;
    apart->accept(count);
    CHECK(count.pairs == tables);

    // What was baked is saved with it, and is not baked again.
    for (const std::string extension : {"osgt", "osgb", "osgx"}) {
        CAPTURE(extension);
        const auto saved = scratch() / ("tank-baked." + extension);
        REQUIRE(osgDB::writeNodeFile(*apart, saved.string()));
        const osg::ref_ptr<osg::Node> again = osgDB::readRefNodeFile(saved.string());
        REQUIRE(again);
        CHECK(lowestOverStowage(*again, frames) > radius - 1e-3);
    }
}

TEST_CASE("a file is baked once, and again when it has changed") {
    const auto file = saveTank(), cache = std::filesystem::path(file.string() + ".cache.tss");
    const std::string words = "pairs=all tolerance=10cm";
    const auto testsOf = [](osg::Node& root) {
        std::vector<std::size_t> counts;
        for (const tss::Pair& pair : osgTSS::Scene::on(root)->getModel().pairs)
            counts.push_back(pair.table ? pair.table->testCount() : 0);
        return counts;
    };
    const osg::ref_ptr<osg::Node> first = load(file.string() + ".tss", words);
    REQUIRE(first);
    REQUIRE(std::filesystem::exists(cache));
    const auto written = std::filesystem::last_write_time(cache);
    const osg::ref_ptr<osg::Node> second = load(file.string() + ".tss", words);
    REQUIRE(second);
    CHECK(testsOf(*second) == testsOf(*first));
    CHECK(std::filesystem::last_write_time(cache) == written);
    CountPairs before, after;
    first->accept(before);
    second->accept(after);
    CHECK(before.pairs.size() > 0);
    CHECK(after.pairs == before.pairs);

    osg::ref_ptr<osg::Group> changed = makeTank();
    find<osgSim::DOFTransform>(*changed, "Gun")->setMaxHPR(osg::Vec3(0, 0.2f, 0));
    REQUIRE(osgDB::writeNodeFile(*changed, file.string()));
    REQUIRE(load(file.string() + ".tss", words));
    CHECK(std::filesystem::last_write_time(cache) != written);

    std::filesystem::remove(cache);
    REQUIRE(load(file.string() + ".tss", words + " cache=off"));
    CHECK_FALSE(std::filesystem::exists(cache));
}

TEST_CASE("a misspelt option is told with the name that was meant") {
    CHECK(osgTSS::nearestOption("tolerence") == "tolerance");
    CHECK(osgTSS::nearestOption("pair") == "pairs");
    CHECK(osgTSS::nearestOption("limit") == "limits");
    CHECK(osgTSS::nearestOption("epsilom") == "epsilon");
    CHECK(osgTSS::nearestOption("noTriStripPolygons").empty());
}

TEST_CASE("a pseudo-loader's wrong option is told and passed over") {
    const Heard heard;
    const osg::ref_ptr<osg::Node> shown =
        load(saveTank().string() + ".tss", "pairs=cousins tolerance=10cm epsilon=wide light=dim");
    REQUIRE(shown);
    CHECK(osgTSS::Scene::on(*shown));
    CHECK(heard.times("option pairs: expected one of neighbours, siblings, all, tagged; found \"cousins\"") ==
          1);
    CHECK(heard.times("\"wide\"") == 1);
    CHECK(heard.times("option light: expected on or off, found \"dim\"") == 1);
}

TEST_CASE("for a first look pairs over many joint values, and they alone, get coarser spheres") {
    // Five boxes in a row, each turned a little against the one before it.
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::Group* above = root;
    for (int k = 0; k < 5; ++k) {
        osg::ref_ptr<osg::MatrixTransform> link =
            new osg::MatrixTransform(osg::Matrix::translate(k > 0 ? 1 : 0, 0, 0));
        link->setName("link" + std::to_string(k));
        if (k > 0) link->setUserValue("osgTSS:dofs", std::string("rotZ:-5:5"));
        link->addChild(nodes::box(osg::Vec3()));
        above->addChild(link);
        above = link;
    }
    const auto settings = [&](const std::string& words, bool firstLook) {
        osgTSS::BakeOptions options(words);
        options.firstLook = firstLook;
        const osg::ref_ptr<osgTSS::Scene> scene = osgTSS::bake(*root, options);
        std::map<std::size_t, std::set<std::string>> byValues; // of how many joint values: the tolerances
        for (const tss::Pair& pair : scene->getModel().pairs) {
            const auto found = pair.settings.find("tolerance");
            byValues[pairDofs(scene->getModel(), pair).size()].insert(
                found == pair.settings.end() ? "" : found->second);
        }
        return byValues;
    };
    using Tolerances = std::set<std::string>;
    auto found = settings("pairs=all", true);
    CHECK(found[1] == Tolerances{""});
    CHECK(found[3] == Tolerances{""});
    CHECK(found[4] == Tolerances{"0.02"}); // of boxes of 0.69
    CHECK(settings("pairs=all", false)[4] == Tolerances{""});
    CHECK(settings("pairs=all tolerance=0.1", true)[4] == Tolerances{"0.1"});
    // And where two of the values go all the way round.
    for (const auto& [words, tolerance] :
         {std::pair("rotZ:-180:180 rotX:-5:5", ""), {"rotZ:-180:180 rotX:-180:180", "0.02"}}) {
        root = new osg::Group;
        root->addChild(nodes::box(osg::Vec3()));
        osg::ref_ptr<osg::MatrixTransform> wrist = new osg::MatrixTransform(osg::Matrix::translate(1, 0, 0));
        wrist->setUserValue("osgTSS:dofs", std::string(words));
        wrist->addChild(nodes::box(osg::Vec3()));
        root->addChild(wrist);
        CHECK(settings("", true)[2] == Tolerances{tolerance});
    }
}

TEST_CASE(
    "a pseudo-loader's file that is not there, or that no plugin reads, is refused with a word of why") {
    const auto refused = [](const std::string& name) {
        const auto result = osgDB::Registry::instance()->readNode((scratch() / name).string(), nullptr);
        CHECK_FALSE(result.success());
        return result.message();
    };
    refused("nothing.osgt.tss");
    std::ofstream(scratch() / "robot.usda") << "#usda 1.0\n";
    CHECK_THAT(refused("robot.usda.tss"), Catch::Contains("'tss make' makes a scene"));
}
