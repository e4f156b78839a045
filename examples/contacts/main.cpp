// Contact events: prints where and how two bodies begin and cease to touch. An application would play a sound
// or start particles there. Arguments: a baked scene, and how many frames to play.
#include <osgTSS/SceneFile>
#include <osgUtil/UpdateVisitor>

#include <cstdlib>
#include <iostream>

namespace {

class Print : public osgTSS::ContactCallback {
public:
    void operator()(const osgTSS::Contact& contact, osg::NodeVisitor& visitor) override {
        if (contact.event == osgTSS::Contact::STAY) return;
        const osg::Vec3d &p = contact.point, &n = contact.normal;
        std::cout << "frame " << visitor.getFrameStamp()->getFrameNumber()
                  << (contact.event == osgTSS::Contact::BEGIN ? ": begins " : ": ends   ") << contact.bodyA
                  << " | " << contact.bodyB << " at " << p.x() << " " << p.y() << " " << p.z() << ", normal "
                  << n.x() << " " << n.y() << " " << n.z() << "\n";
    }
};

} // namespace

int main(int argc, char** argv) {
    osg::ref_ptr<osgTSS::Scene> scene = osgTSS::readScene(argc > 1 ? argv[1] : "dog_jaw_baked.tss");
    const unsigned int frames = argc > 2 ? static_cast<unsigned int>(std::atoi(argv[2])) : 100;
    osg::ref_ptr<osg::Group> graph = osgTSS::createPlayingGraph(*scene, osgTSS::LoadOptions("clock=frame"));
    scene->setContactCallback(new Print);

    osgUtil::UpdateVisitor update; // what a viewer does each frame, without a window
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    update.setFrameStamp(stamp);
    for (unsigned int frame = 0; frame < frames; ++frame) {
        stamp->setFrameNumber(frame);
        update.setTraversalNumber(frame);
        graph->accept(update);
    }
}
