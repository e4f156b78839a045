#include "Files.h"

#include <catch2/catch.hpp>
#include <osgTSS/Overlay>
#include <osgTSS/SceneFile>
#include <osgTSS/SkinGeometry>
#include <osgUtil/Optimizer>

#include <set>

using namespace files;

namespace {

std::vector<std::string> bakedScenes() {
    std::vector<std::string> scenes;
    const std::string ending = "_baked.tss";
    for (const auto& entry : std::filesystem::directory_iterator(OSGTSS_SOURCE_DIR "/scenes"))
        if (entry.path().string().ends_with(ending)) scenes.push_back(entry.path().string());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

/// Where everything of a graph stands: all joints' values and all skins' vertices.
class State : public osg::NodeVisitor {
public:
    State() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Node& node) override {
        if (const auto* joint = dynamic_cast<osgTSS::JointTransform*>(&node))
            numbers.insert(numbers.end(), joint->getValues().begin(), joint->getValues().end());
        if (const auto* skin = dynamic_cast<osgTSS::SkinGeometry*>(&node))
            for (const osg::Vec3& vertex : *skin->getVertices())
                numbers.insert(numbers.end(), vertex.ptr(), vertex.ptr() + 3);
        traverse(node);
    }
    std::vector<double> numbers;
};

std::vector<std::vector<double>> play(osg::Node& root, unsigned int frames, unsigned int step) {
    Playback playback;
    std::vector<std::vector<double>> states;
    for (unsigned int frame = 0; frame < frames; frame += step) {
        playback.frame(root, frame);
        State state;
        root.accept(state);
        states.push_back(state.numbers);
    }
    return states;
}

std::vector<std::vector<double>> sorted(std::vector<std::vector<double>> states) {
    for (std::vector<double>& numbers : states) std::sort(numbers.begin(), numbers.end());
    return states;
}

/// .tss -> .osgt -> .osgb -> .osgx -> .tss, each read from the one before.
void checkCycle(const std::string& scene, unsigned int frames, unsigned int step) {
    CAPTURE(scene);
    osg::ref_ptr<osg::Node> graph = load(scene);
    REQUIRE(graph);
    const auto states = play(*graph, frames, step);
    REQUIRE_FALSE(states[0].empty());
    std::set<std::vector<double>> different(states.begin(), states.end());
    CHECK(different.size() > 2); // something moves
    graph = load(scene);
    for (const std::string extension : {"osgt", "osgb", "osgx", "tss"}) {
        CAPTURE(extension);
        const auto file = scratch() / ("cycle." + extension);
        REQUIRE(osgDB::writeNodeFile(*graph, file.string()));
        graph = load(file);
        REQUIRE(graph);
        CHECK(play(*load(file), frames, step) == states);
    }
}

} // namespace

TEST_CASE("every scene comes back through .osgt, .osgb, .osgx and .tss with the same states") {
    const auto scenes = bakedScenes();
    REQUIRE(scenes.size() >= 2);
    for (const std::string& scene : scenes) checkCycle(scene, 37, 12);
}

TEST_CASE("every scene comes back with the same states at all its frames", "[.long]") {
    for (const std::string& scene : bakedScenes()) checkCycle(scene, 97, 1);
}

TEST_CASE("every scene is the same after osgUtil::Optimizer with everything on") {
    for (const std::string& scene : bakedScenes()) {
        CAPTURE(scene);
        osg::ref_ptr<osg::Group> world = new osg::Group;
        world->addChild(load(scene));
        osgUtil::Optimizer optimizer;
        optimizer.optimize(world, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
        // The optimizer may put many children into groups of its own: the same numbers, in another order.
        CHECK(sorted(play(*world, 37, 12)) == sorted(play(*load(scene), 37, 12)));
        CHECK(osgTSS::Overlay::find(*world));
    }
}

TEST_CASE("fifty times loading a scene, running it and unloading the plugins") {
    usePlugins();
    osgDB::Registry& registry = *osgDB::Registry::instance();
    std::vector<std::vector<double>> first;
    for (int cycle = 0; cycle < 50; ++cycle) {
        const osg::ref_ptr<osg::Node> graph = load(saveHinge());
        REQUIRE(graph);
        const auto states = play(*graph, 24, 4);
        if (cycle == 0) first = states;
        CHECK(states == first);
        if (cycle % 10 == 0) REQUIRE(osgDB::writeNodeFile(*graph, (scratch() / "cycle.osgb").string()));
        registry.closeLibrary(registry.createLibraryNameForExtension("tss"));
    }
}

TEST_CASE("an overlay is hidden until it is asked for, has no bound and is not saved as geometry") {
    const osg::ref_ptr<osg::Node> hidden = load(saveHinge()),
                                  shown = load(saveHinge(), "clock=frame overlay");
    REQUIRE(osgTSS::Overlay::find(*hidden));
    CHECK_FALSE(osgTSS::Overlay::find(*hidden)->getShown());
    CHECK(osgTSS::Overlay::find(*shown)->getShown());
    CHECK(hidden->getBound() == shown->getBound());
    osg::ref_ptr<osg::Group> world = new osg::Group;
    world->addChild(shown);
    CHECK(states(*world) == states(*hidden));
    const auto file = scratch() / "overlay.osgt";
    REQUIRE(osgDB::writeNodeFile(*shown, file.string()));
    const osg::ref_ptr<osg::Node> again = load(file);
    REQUIRE(again);
    REQUIRE(osgTSS::Overlay::find(*again));
    CHECK(osgTSS::Overlay::find(*again)->getNumChildren() == 0);
}
