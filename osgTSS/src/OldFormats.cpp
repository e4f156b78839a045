#include "OldFormats.h"
#include "EachNode.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>
#include <osgTSS/JointTransform>
#include <osgTSS/LimitsCallback>
#include <osgTSS/SkinCallback>
#include <osgTSS/SkinGeometry>

#include <string_view>

namespace osgTSS {

namespace {

void tell(const osg::Object& object, const char* format) {
    const auto* skin = dynamic_cast<const SkinGeometry*>(&object);
    const std::string& name = skin ? skin->getPath() : object.getName();
    OSG_WARN << "osgTSS: " << object.className() << (name.empty() ? "" : " \"" + name + "\"")
             << " is lost in an " << format << " file, which keeps no tables, joints and skins of osgTSS: "
             << "expected .osgt, .osgb, .osgx or .tss" << std::endl;
}

bool tellOfOsg(const osg::Object& object, osgDB::Output&) {
    tell(object, ".osg");
    return true;
}

/// Is asked before the plugin that writes .ive, which has no wrappers of classes that could tell, and leaves
/// the writing to it.
class IveWatch : public osgDB::ReaderWriter {
public:
    const char* className() const override { return "What is lost in an .ive file"; }

    WriteResult writeNode(const osg::Node& node, const std::string& file, const Options*) const override {
        if (osgDB::getLowerCaseFileExtension(file) == "ive")
            eachNode(const_cast<osg::Node&>(node), [](osg::Node& each) {
                tellIfOurs(each);
                for (osg::Callback* c = each.getUpdateCallback(); c; c = c->getNestedCallback())
                    tellIfOurs(*c);
            });
        return WriteResult::FILE_NOT_HANDLED;
    }

private:
    static void tellIfOurs(const osg::Object& object) {
        if (object.libraryName() == std::string_view("osgTSS")) tell(object, ".ive");
    }
};

const osgDB::RegisterReaderWriterProxy<IveWatch> watch;

} // namespace

void warnOfOldFormats() {
    static const auto once = [] {
        for (const osg::ref_ptr<osg::Object>& object :
             {osg::ref_ptr<osg::Object>(new JointTransform), osg::ref_ptr<osg::Object>(new SkinGeometry),
              osg::ref_ptr<osg::Object>(new LimitsCallback), osg::ref_ptr<osg::Object>(new SkinCallback)}) {
            const std::string name = std::string(object->libraryName()) + "::" + object->className();
            osgDB::Registry::instance()->getDeprecatedDotOsgObjectWrapperManager()->addDotOsgWrapper(
                new osgDB::DotOsgWrapper(object, name, name, nullptr, tellOfOsg));
        }
        return true;
    }();
    (void)once;
}

} // namespace osgTSS
