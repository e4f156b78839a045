#include "DotOsg.h"

#include <osg/Notify>
#include <osgDB/Registry>
#include <osgTSS/JointTransform>
#include <osgTSS/LimitsCallback>
#include <osgTSS/SkinCallback>
#include <osgTSS/SkinGeometry>

namespace osgTSS {

namespace {

bool tell(const osg::Object& object, osgDB::Output&) {
    const auto* skin = dynamic_cast<const SkinGeometry*>(&object);
    const std::string& name = skin ? skin->getPath() : object.getName();
    OSG_WARN << "osgTSS: " << object.className() << (name.empty() ? "" : " \"" + name + "\"")
             << " is lost in an .osg file, which keeps no tables, joints and skins of osgTSS: expected "
             << ".osgt, .osgb, .osgx or .tss" << std::endl;
    return true;
}

} // namespace

void warnOfDotOsg() {
    static const auto once = [] {
        for (const osg::ref_ptr<osg::Object>& object :
             {osg::ref_ptr<osg::Object>(new JointTransform), osg::ref_ptr<osg::Object>(new SkinGeometry),
              osg::ref_ptr<osg::Object>(new LimitsCallback), osg::ref_ptr<osg::Object>(new SkinCallback)}) {
            const std::string name = std::string(object->libraryName()) + "::" + object->className();
            osgDB::Registry::instance()->getDeprecatedDotOsgObjectWrapperManager()->addDotOsgWrapper(
                new osgDB::DotOsgWrapper(object, name, name, nullptr, tell));
        }
        return true;
    }();
    (void)once;
}

} // namespace osgTSS
