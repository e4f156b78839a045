#include <osg/NodeVisitor>
#include <osgTSS/DriveCallback>
#include <osgTSS/JointTransform>

namespace osgTSS {

DriveCallback::DriveCallback(const DriveCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), SceneCallback(other, copyop) {}

bool DriveCallback::run(osg::Object* object, osg::Object* data) {
    auto* joint = dynamic_cast<JointTransform*>(object);
    osg::NodeVisitor* visitor = data ? data->asNodeVisitor() : nullptr;
    if (joint && visitor && visitor->getFrameStamp() && _scene) {
        const double time = _scene->getClock().timeCode(*visitor->getFrameStamp());
        const std::vector<tss::TimeSamples>& drives = joint->getJoint().drives;
        std::vector<double> asked = joint->getAskedValues();
        for (std::size_t k = 0; k < asked.size() && k < drives.size(); ++k)
            if (!drives[k].empty()) asked[k] = drives[k].at(time);
        joint->setValues(asked);
    }
    return traverse(object, data);
}

} // namespace osgTSS
