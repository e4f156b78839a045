#include "JointText.h"

#include "bake/base/Error.h"

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>
#include <osgTSS/JointTransform>

static bool checkJoint(const osgTSS::JointTransform&) {
    return true;
}

static bool readJoint(osgDB::InputStream& is, osgTSS::JointTransform& node) {
    std::string line;
    is.readWrappedString(line);
    try {
        const JointText text = readJointText(line);
        node.setJoint(text.joint);
        node.setValues(text.asked);
        node.setResolvedValues(text.values);
        return true;
    } catch (const tss::InputError& error) {
        is.throwException(std::string("osgTSS::JointTransform: ") + error.what());
        return false;
    }
}

static bool writeJoint(osgDB::OutputStream& os, const osgTSS::JointTransform& node) {
    os.writeWrappedString(writeJointText({node.getJoint(), node.getAskedValues(), node.getValues()}));
    os << std::endl;
    return true;
}

REGISTER_OBJECT_WRAPPER(osgTSS_JointTransform, new osgTSS::JointTransform, osgTSS::JointTransform,
                        "osg::Object osg::Node osg::Group osg::Transform osgTSS::JointTransform") {
    ADD_USER_SERIALIZER(Joint);
}
