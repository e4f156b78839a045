// A crowd that shares one table: many copies of a scene's graph, each moved by the application at a pace of
// its own. Without arguments for a viewer it measures: what an update traversal takes with the joints kept
// apart and without, and what of it is osgTSS.
//     crowd SCENE [COUNT] [FRAMES]          figures on the terminal
//     crowd SCENE COUNT view                the same in a window
#include <osg/MatrixTransform>
#include <osg/Timer>
#include <osgTSS/Install>
#include <osgTSS/JointTransform>
#include <osgTSS/SceneFile>
#include <osgUtil/UpdateVisitor>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

namespace {

/// Moves every DOF of a joint to and fro through its limits.
class Wander : public osg::Callback {
public:
    explicit Wander(double phase) : _phase(phase) {}
    bool run(osg::Object* object, osg::Object* data) override {
        auto* joint = static_cast<osgTSS::JointTransform*>(object);
        const double time = data->asNodeVisitor()->getFrameStamp()->getSimulationTime();
        _values.clear();
        for (unsigned int k = 0; k < joint->getNumDofs(); ++k) {
            const tss::Dof& dof = joint->getDof(k);
            const double wave = 0.5 + 0.5 * std::sin((2 + k) * (time + _phase));
            _values.push_back(dof.lower + wave * (dof.upper - dof.lower));
        }
        joint->setValues(_values);
        return traverse(object, data);
    }

private:
    double _phase;
    std::vector<double> _values;
};

class EachJoint : public osg::NodeVisitor {
public:
    explicit EachJoint(double phase) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _phase(phase) {}
    void apply(osg::Transform& node) override {
        if (dynamic_cast<osgTSS::JointTransform*>(&node)) {
            node.setUpdateCallback(nullptr);
            node.addUpdateCallback(new Wander(_phase));
        }
        traverse(node);
    }

private:
    double _phase;
};

osg::ref_ptr<osg::Group> makeCrowd(osgTSS::Scene& scene, unsigned int count, bool keptApart) {
    osg::ref_ptr<osg::Group> one = osgTSS::createGraph(scene);
    const float room = 2.2f * one->getBound().radius();
    const unsigned int side = static_cast<unsigned int>(std::ceil(std::sqrt(count)));
    osg::ref_ptr<osg::Group> crowd = new osg::Group;
    for (unsigned int i = 0; i < count; ++i) {
        osg::ref_ptr<osg::Group> member = osg::clone(one.get(), osg::CopyOp::DEEP_COPY_NODES);
        EachJoint wander(0.37 * i);
        member->accept(wander);
        if (keptApart) osgTSS::install(*member, scene);
        const unsigned int column = i % side, row = i / side;
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(
            osg::Matrix::translate(room * static_cast<float>(column), room * static_cast<float>(row), 0));
        place->addChild(member);
        crowd->addChild(place);
    }
    return crowd;
}

/// Median milliseconds of an update traversal.
double updateTime(osg::Node& crowd, unsigned int frames) {
    osgUtil::UpdateVisitor update;
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    update.setFrameStamp(stamp);
    std::vector<double> times;
    for (unsigned int frame = 0; frame < frames; ++frame) {
        stamp->setFrameNumber(frame);
        stamp->setSimulationTime(frame / 60.0);
        update.setTraversalNumber(frame);
        const osg::Timer_t start = osg::Timer::instance()->tick();
        crowd.accept(update);
        times.push_back(osg::Timer::instance()->delta_m(start, osg::Timer::instance()->tick()));
    }
    std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
    return times[times.size() / 2];
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::cerr << "usage: crowd SCENE [COUNT] [FRAMES|view]\n";
        return 2;
    }
    osg::ref_ptr<osgTSS::Scene> scene = osgTSS::readScene(argv[1]);
    const unsigned int count = argc > 2 ? static_cast<unsigned int>(std::atoi(argv[2])) : 1000;
    if (argc > 3 && std::string(argv[3]) == "view") {
        osgViewer::Viewer viewer;
        viewer.setSceneData(makeCrowd(*scene, count, true));
        return viewer.run();
    }
    const unsigned int frames = argc > 3 ? static_cast<unsigned int>(std::atoi(argv[3])) : 300;
    const double without = updateTime(*makeCrowd(*scene, count, false), frames);
    const double with = updateTime(*makeCrowd(*scene, count, true), frames);
    std::cout << count << " instances of one table, median of " << frames << " update traversals:\n"
              << "  moved by the application alone  " << without << " ms\n"
              << "  and kept apart                  " << with << " ms, osgTSS "
              << 1000 * (with - without) / count << " us an instance\n";
}
