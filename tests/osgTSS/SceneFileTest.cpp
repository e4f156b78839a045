#include "Files.h"
#include "Heard.h"
#include "Nodes.h"

#include <osgTSS/JointCallback>
#include <osgTSS/Scene>
#include <osgTSS/SceneFile>
#include <osgUtil/Optimizer>

#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace files;

namespace {

/// The joint is stopped in some frames and moves in others.
void checkPlays(osg::Node& root) {
    auto* joint = find<osgTSS::JointTransform>(root, "Hinge");
    REQUIRE(joint);
    Playback playback;
    double farthest = 0;
    for (unsigned int frame = 0; frame < 24; ++frame) {
        playback.frame(root, frame);
        farthest = std::max(farthest, joint->getValue(0));
    }
    CHECK(farthest == Approx(scenes::contactAngle()).margin(1e-3));
}

} // namespace

TEST_CASE("a .tss file is read as a graph that plays and stops at contact") {
    const osg::ref_ptr<osg::Node> root = load(saveHinge());
    REQUIRE(root);
    CHECK(osgTSS::Scene::on(*root));
    checkPlays(*root);
}

TEST_CASE("readObject answers as readNode does") {
    usePlugins();
    const osg::ref_ptr<osg::Object> object = osgDB::readRefObjectFile(saveHinge().string());
    REQUIRE(object);
    CHECK(object->asNode());
}

TEST_CASE("a graph written as .tss and read again has the same states at the same frames") {
    const osg::ref_ptr<osg::Node> first = load(saveHinge());
    REQUIRE(first);
    const auto copy = scratch() / "copy.tss";
    REQUIRE(osgDB::writeNodeFile(*first, copy.string()));
    const osg::ref_ptr<osg::Node> second = load(copy);
    REQUIRE(second);
    CHECK(states(*first) == states(*second));
    SECTION("also when it was written in the middle of playing") {
        REQUIRE(osgDB::writeNodeFile(*first, copy.string()));
        CHECK(states(*load(saveHinge())) == states(*load(copy)));
    }
}

TEST_CASE("a graph that has become another since its tables came is written with a warning") {
    const osg::ref_ptr<osg::Node> root = files::load(files::saveHinge());
    REQUIRE(root);
    const std::string file = (files::scratch() / "other.tss").string();
    const Heard heard;
    osgTSS::writeScene(*root, file);
    CHECK(heard.times("the scene") == 0);
    SECTION("by geometry") {
        root->asGroup()->addChild(nodes::box(osg::Vec3(0, 0, 50)));
        osgTSS::writeScene(*root, file);
        CHECK(heard.times("has 24 triangles, and the graph 36") == 1);
    }
    SECTION("by a further parent of a joint") {
        const osg::ref_ptr<osg::MatrixTransform> beside =
            new osg::MatrixTransform(osg::Matrix::translate(0, 9, 0));
        beside->addChild(find<osgTSS::JointTransform>(*root, "Hinge"));
        root->asGroup()->addChild(beside);
        osgTSS::writeScene(*root, file);
        CHECK(heard.times("joint /Rig/Hinge is there over several parents") == 1);
        const std::string other = (files::scratch() / "other.osgb").string();
        REQUIRE(osgDB::writeNodeFile(*root, other));
        Playback().frames(*files::load(other), 0, 3);
        CHECK(heard.times("joint /Rig/Hinge is there over several parents") == 2);
    }
}

TEST_CASE("after osgUtil::Optimizer with everything on, the states are the same") {
    const osg::ref_ptr<osg::Node> plain = load(saveHinge());
    osg::ref_ptr<osg::Group> world = new osg::Group;
    world->addChild(load(saveHinge()));
    osgUtil::Optimizer optimizer;
    optimizer.optimize(world, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    CHECK(states(*plain) == states(*world));
    const auto copy = scratch() / "optimized.tss";
    REQUIRE(osgDB::writeNodeFile(*world, copy.string()));
    CHECK(states(*plain) == states(*load(copy)));
}

TEST_CASE("a file with a mistake is refused with its place") {
    const auto file = scratch() / "broken.tss";
    std::ofstream(file)
        << R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [{"specifier": "def", "name": "A", "typeName": 5}]})";
    usePlugins();
    const auto result = osgDB::Registry::instance()->readNode(file.string(), nullptr);
    CHECK(result.status() == osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
    CHECK(result.message().find("broken.tss") != std::string::npos);
    CHECK(result.message().find("/primChildren/0") != std::string::npos);
}

TEST_CASE("an option with a wrong value is told, and the scene is shown all the same") {
    const Heard heard;
    const osg::ref_ptr<osg::Node> root = load(saveHinge(), "clock=sundial overlay=perhaps");
    REQUIRE(root);
    CHECK(osgTSS::Scene::on(*root)->getClock().source == osgTSS::Clock::SIMULATION_TIME);
    CHECK(heard.times("option clock: expected frame or time, found \"sundial\"") == 1);
    CHECK(heard.times("option overlay: expected on or off, found \"perhaps\"") == 1);
}

TEST_CASE("the environment says which clock where no option does") {
    setenv("OSGTSS_CLOCK", "frame", 1);
    const osg::ref_ptr<osg::Node> root = load(saveHinge(), "");
    unsetenv("OSGTSS_CLOCK");
    REQUIRE(root);
    CHECK(osgTSS::Scene::on(*root)->getClock().source == osgTSS::Clock::FRAME_NUMBER);
    CHECK(osgTSS::Scene::on(*load(saveHinge(), ""))->getClock().source == osgTSS::Clock::SIMULATION_TIME);
}

TEST_CASE("a table that was made from other limits is refused, with the reason") {
    std::string text = osgTSS::readScene(saveHinge().string())->getText();
    const std::size_t at = text.find("86", text.find("physics:upperLimit"));
    REQUIRE(at != std::string::npos);
    text.replace(at, 2, "85");
    const auto file = scratch() / "stale.tss";
    std::ofstream(file) << text;
    const auto result = osgDB::Registry::instance()->readNode(file.string(), nullptr);
    CHECK(result.status() == osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
    CHECK(result.message().find("stale") != std::string::npos);
}

TEST_CASE("a scene is read from a stream as from its file") {
    const osg::ref_ptr<osg::Node> file = load(saveHinge());
    std::ifstream stream(saveHinge());
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clock=frame");
    osgDB::ReaderWriter* plugin = osgDB::Registry::instance()->getReaderWriterForExtension("tss");
    REQUIRE(plugin);
    const osg::ref_ptr<osg::Node> streamed = plugin->readNode(stream, options).takeNode();
    REQUIRE(streamed);
    CHECK(states(*streamed) == states(*file));
    std::istringstream nonsense("{");
    CHECK_FALSE(plugin->readNode(nonsense, options).validNode());
}
