// An application's own graph, baked, kept out of collision, and heard of: all that osgTSS needs of it. C++17.
#include <osg/ShapeDrawable>
#include <osgSim/DOFTransform>
#include <osgTSS/Bake>
#include <osgTSS/Install>
#include <osgUtil/UpdateVisitor>

#include <iostream>

struct Print : osgTSS::ContactCallback {
    void operator()(const osgTSS::Contact& contact, osg::NodeVisitor&) override {
        const char* const events[] = {"begins", "stays", "ends"};
        std::cout << contact.pairPath << " " << events[contact.event] << " at " << contact.point.x() << "\n";
    }
};

int main() {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(3, 0, 0), 1)));
    osg::ref_ptr<osgSim::DOFTransform> slide = new osgSim::DOFTransform;
    slide->setName("Slide");
    slide->setCurrentScale(osg::Vec3(1, 1, 1));
    slide->setLimitationFlags(0xff800000ul);
    slide->setMaxTranslate(osg::Vec3(5, 0, 0));
    slide->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 1)));
    root->addChild(slide);

    osg::ref_ptr<osgTSS::Scene> scene = osgTSS::bake(*root, osgTSS::BakeOptions("tolerance=0.01"));
    osgTSS::install(*root, *scene);
    scene->setContactCallback(new Print);

    osgUtil::UpdateVisitor update; // what a viewer does each frame
    update.setFrameStamp(new osg::FrameStamp);
    for (unsigned int frame = 0; frame < 12; ++frame) {
        slide->setCurrentTranslate(osg::Vec3(frame < 9 ? 0.5f * frame : 0.f, 0, 0));
        update.setTraversalNumber(frame);
        root->accept(update);
        std::cout << "frame " << frame << ": " << slide->getCurrentTranslate().x() << "\n";
    }
}
