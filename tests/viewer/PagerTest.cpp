#include "Pictures.h"

#include <catch2/catch.hpp>
#include <osg/PagedLOD>
#include <osgDB/DatabasePager>
#include <osgTSS/JointTransform>

namespace {

/// All joints below a node.
class Joints : public osg::NodeVisitor {
public:
    Joints() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Transform& node) override {
        if (auto* joint = dynamic_cast<osgTSS::JointTransform*>(&node)) found.push_back(joint);
        traverse(node);
    }
    std::vector<osg::ref_ptr<osgTSS::JointTransform>> found;
};

} // namespace

TEST_CASE("scenes that the DatabasePager loads while the viewer runs play and are kept apart") {
    if (!pictures::haveDisplay()) {
        WARN("skipped, no display");
        return;
    }
    pictures::load("dog_jaw_baked.tss"); // finds the plugins
    osg::ref_ptr<osg::Group> world = new osg::Group;
    for (int i = 0; i < 3; ++i) {
        osg::ref_ptr<osg::PagedLOD> paged = new osg::PagedLOD;
        paged->setFileName(0, OSGTSS_SOURCE_DIR "/scenes/dog_jaw_baked.tss");
        paged->setRange(0, 0, 1e9f);
        paged->setCenter(osg::Vec3(0, 0, 0));
        paged->setRadius(200);
        paged->setDatabaseOptions(new osgDB::Options("clock=frame"));
        world->addChild(paged);
    }
    osg::ref_ptr<pictures::Keep> keep = new pictures::Keep;
    const osg::ref_ptr<osgViewer::Viewer> viewer =
        pictures::makeViewer(*world, osgViewer::ViewerBase::DrawThreadPerContext, *keep);
    viewer->realize();
    Joints joints;
    constexpr unsigned int most = 20000;
    for (unsigned int frame = 0; frame < most && joints.found.size() < 3; ++frame) {
        viewer->frame();
        joints.found.clear();
        world->accept(joints);
    }
    REQUIRE(joints.found.size() == 3);
    // Each by itself: they came at different frames, and where a joint is held depends on the way there.
    std::vector<int> held(3), moved(3);
    std::vector<std::vector<double>> before(3);
    for (unsigned int frame = 0; frame < 97; ++frame) {
        viewer->frame();
        for (std::size_t i = 0; i < 3; ++i) {
            const osgTSS::JointTransform& joint = *joints.found[i];
            held[i] += joint.getValues() != joint.getAskedValues();
            moved[i] += joint.getValues() != before[i];
            before[i] = joint.getValues();
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(held[i] > 10);
        CHECK(moved[i] > 30);
    }
    viewer->setDone(true);
    viewer->stopThreading();
}
