#pragma once
#include <osg/FrameStamp>
#include <osg/Node>
#include <osg/Transform>
#include <osgUtil/UpdateVisitor>

#include <string>
#include <vector>

/// Update traversals by hand, as a viewer makes them.
class Playback {
public:
    explicit Playback(double framesPerSecond = 24) : _rate(framesPerSecond) {
        _visitor = new osgUtil::UpdateVisitor;
        _stamp = new osg::FrameStamp;
        _visitor->setFrameStamp(_stamp);
    }

    void frame(osg::Node& root, unsigned int number) {
        _stamp->setFrameNumber(number);
        _stamp->setSimulationTime(number / _rate);
        _stamp->setReferenceTime(number / _rate);
        _visitor->setTraversalNumber(number);
        root.accept(*_visitor);
    }

    void frames(osg::Node& root, unsigned int first, unsigned int last) {
        for (unsigned int number = first; number <= last; ++number) frame(root, number);
    }

private:
    double _rate;
    osg::ref_ptr<osgUtil::UpdateVisitor> _visitor;
    osg::ref_ptr<osg::FrameStamp> _stamp;
};

/// The first node below (or at) the root that is a T, and has this name when one is given.
template <class T>
class Finder : public osg::NodeVisitor {
public:
    explicit Finder(std::string name) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _name(std::move(name)) {
        setNodeMaskOverride(~0u);
    }
    void apply(osg::Node& node) override {
        auto* match = dynamic_cast<T*>(&node);
        if (match && !found && (_name.empty() || node.getName() == _name)) found = match;
        traverse(node);
    }
    T* found = nullptr;

private:
    std::string _name;
};

template <class T>
T* find(osg::Node& root, const std::string& name = "") {
    Finder<T> finder(name);
    root.accept(finder);
    return finder.found;
}

/// Where a point of the node's own frame stands in the world.
inline osg::Vec3d toWorld(osg::Node& node, const osg::Vec3d& point) {
    return point * node.getWorldMatrices().at(0);
}
