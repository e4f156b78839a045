#pragma once
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgSim/DOFTransform>

#include <string>

/// So many nodes, all named; the joints hang side by side under the root in chains of four, and the other
/// nodes are transforms with a box each, spread evenly.
inline osg::ref_ptr<osg::Group> largeGraph(unsigned int nodes, unsigned int joints) {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("Large");
    const osg::ref_ptr<osg::ShapeDrawable> box = new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.2f));
    osg::Group* parent = root;
    unsigned int made = 1;
    const auto add = [&](osg::Node* node, osg::Group& below) {
        node->setName("Node" + std::to_string(made++));
        below.addChild(node);
    };
    for (unsigned int j = 0; j < joints; ++j) {
        osg::ref_ptr<osgSim::DOFTransform> joint = new osgSim::DOFTransform;
        joint->setCurrentScale(osg::Vec3(1, 1, 1));
        joint->setMinHPR(osg::Vec3(-1, 0, 0));
        joint->setMaxHPR(osg::Vec3(1, 0, 0));
        joint->setAnimationOn(false);
        add(joint, j % 4 == 0 ? *root : *parent);
        parent = joint;
        const unsigned int until = (j + 1) * nodes / joints;
        while (made < until) {
            osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(
                osg::Matrix::translate(0.3 * (made % 10), 0.3 * j, 0.3 * (made % 7)));
            place->addChild(box);
            add(place, made % 49 == 0 ? *root : *parent);
        }
    }
    return root;
}
