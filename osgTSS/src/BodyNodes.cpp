#include "BodyNodes.h"

#include <osg/NodeVisitor>
#include <osg/ValueObject>

namespace osgTSS {

namespace {

const char* const tagName = "osgTSS:body";

class FindBodyNodes : public osg::NodeVisitor {
public:
    FindBodyNodes() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override {
        std::string path;
        if (auto* shape = dynamic_cast<SkinGeometry*>(&node)) found.shapes.emplace(shape->getPath(), shape);
        if (node.getUserValue(tagName, path)) found.frames.emplace(path, &node);
        traverse(node);
    }

    BodyNodes found;
};

} // namespace

void tagBody(osg::Node& node, const std::string& bodyPath) {
    node.setUserValue(tagName, bodyPath);
}

BodyNodes findBodyNodes(osg::Node& root) {
    FindBodyNodes visitor;
    root.accept(visitor);
    return visitor.found;
}

} // namespace osgTSS
