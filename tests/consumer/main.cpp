// An application outside the tree: plays a baked scene, read by the library and by the plugin, and sees its
// joint held back. Arguments: the scene. Exit 0 when all of it was so.
#include <bake/model/Kinematics.h>
#include <bake/motion/MotionFrame.h>
#include <bake/play/Player.h>
#include <bake/respond/JointResponder.h>
#include <bake/scene/Layer.h>
#include <bake/scene/SceneFile.h>
#include <bake/table/PreparedTable.h>
#include <bake/table/TablePairs.h>

#include <osgDB/ReadFile>
#include <osgTSS/Install>
#include <osgTSS/JointTransform>
#include <osgTSS/SceneFile>
#include <osgTSS/Version>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cstring>
#include <iostream>

namespace {

class FindJoint : public osg::NodeVisitor {
public:
    FindJoint() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Transform& node) override {
        if (auto* found = dynamic_cast<osgTSS::JointTransform*>(&node)) joint = found;
        traverse(node);
    }
    osgTSS::JointTransform* joint = nullptr;
};

/// In how many of the scene's frames the joint was kept from what it was asked for; -1 without a joint.
int framesHeldBack(osg::Node& root) {
    FindJoint find;
    root.accept(find);
    if (!find.joint) return -1;
    const osgTSS::Scene* scene = osgTSS::Scene::on(root);
    int held = 0;
    osgUtil::UpdateVisitor update;
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    update.setFrameStamp(stamp);
    for (unsigned int frame = 0; frame <= scene->getModel().endTimeCode; ++frame) {
        stamp->setFrameNumber(frame);
        update.setTraversalNumber(frame);
        root.accept(update);
        held += find.joint->getValues() != find.joint->getAskedValues();
    }
    return held;
}

/// What the installed headers declare can be called with no others: the types that it gives are there, too.
bool coreAnswers(const tss::SceneModel& scene, const tss::PreparedTable& table) {
    const std::vector<double> rest = tss::restValues(tss::pairMotion(scene, scene.pairs.at(0)));
    tss::MotionFrame frame;
    table.frame(rest.data(), frame);
    std::vector<std::string> warnings;
    tss::Player player(scene, warnings);
    player.step(rest, 0);
    return frame.pose.matrix().allFinite() && player.following().size() == scene.skins.size() &&
           tss::posedBodies(scene, rest).size() == scene.bodies.size() &&
           tss::layerOf(scene).children.size() == 1 && table.pair(0).contactDistance > 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    if (std::strcmp(osgTSSGetVersion(), OSGTSS_VERSION_STRING) != 0) {
        std::cerr << "headers " OSGTSS_VERSION_STRING ", library " << osgTSSGetVersion() << "\n";
        return 1;
    }
    osgTSS::LoadOptions options("clock=frame");
    osg::ref_ptr<osgTSS::Scene> scene = osgTSS::readScene(argv[1]);
    const int held = framesHeldBack(*osgTSS::createPlayingGraph(*scene, options));

    osg::ref_ptr<osgDB::Options> words = new osgDB::Options("clock=frame");
    osg::ref_ptr<osg::Node> loaded = osgDB::readRefNodeFile(argv[1], words);
    const int heldByPlugin = loaded ? framesHeldBack(*loaded) : -1;

    // The core is in the same library.
    const tss::Table& table = *scene->getModel().pairs.at(0).table;
    const tss::PreparedTable prepared(table);
    const tss::JointResponder responder(table);

    std::cout << "osgTSS " << osgTSSGetVersion() << ": " << prepared.testCount() << " tests, "
              << responder.dofCount() << " DOFs, held back in " << held << " frames, by the plugin in "
              << heldByPlugin << "\n";
    return held > 0 && held == heldByPlugin && coreAnswers(scene->getModel(), prepared) ? 0 : 1;
}
