#pragma once
#include <osg/NodeVisitor>

namespace osgTSS {

/// Calls visit(node) for a node and then for each one below it, masked ones too.
template <class Visit>
void eachNode(osg::Node& root, const Visit& visit) {
    class Visitor : public osg::NodeVisitor {
    public:
        explicit Visitor(const Visit& visit) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _visit(visit) {
            setNodeMaskOverride(~0u);
        }
        void apply(osg::Node& node) override {
            _visit(node);
            traverse(node);
        }

    private:
        const Visit& _visit;
    } visitor(visit);
    root.accept(visitor);
}

} // namespace osgTSS
