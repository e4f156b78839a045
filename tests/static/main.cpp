// A program that loads no plugin of osgTSS: it has them in itself. Reads a baked scene, writes it as .osgt
// and reads that back. Argument: the scene.
#include <osg/NodeVisitor>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>
#include <osgTSS/JointCallback>
#include <osgTSS/Version>

#include <iostream>

USE_OSGPLUGIN(tss)
USE_SERIALIZER_WRAPPER_LIBRARY(osgTSS)

namespace {

/// How many nodes are kept out of collision.
class Count : public osg::NodeVisitor {
public:
    Count() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Node& node) override {
        for (osg::Callback* c = node.getUpdateCallback(); c; c = c->getNestedCallback())
            joints += dynamic_cast<osgTSS::JointCallback*>(c) != nullptr;
        traverse(node);
    }
    int joints = 0;
};

int jointsOf(osg::Node* node) {
    Count count;
    if (node) node->accept(count);
    return count.joints;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(argv[1]);
    const std::string copy = "static_player.osgt";
    osg::ref_ptr<osg::Node> back;
    if (scene && osgDB::writeNodeFile(*scene, copy)) back = osgDB::readRefNodeFile(copy);
    const int first = jointsOf(scene), second = jointsOf(back);
    std::cout << osgTSSGetLibraryName() << " " << osgTSSGetVersion() << ": " << first
              << " joint callbacks, read back " << second << "\n";
    return first > 0 && second == first ? 0 : 1;
}
