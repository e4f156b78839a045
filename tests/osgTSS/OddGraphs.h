#pragma once
#include "Nodes.h"

#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/Camera>
#include <osg/Geode>
#include <osg/LOD>
#include <osg/PagedLOD>
#include <osg/Projection>
#include <osg/ProxyNode>
#include <osg/Sequence>
#include <osg/Switch>
#include <osgSim/MultiSwitch>

#include <functional>
#include <limits>
#include <string>
#include <vector>

/// What graphs of other people hold beside joints.
namespace odd {

/// The eight corners of a cube.
inline std::vector<osg::Vec3d> corners(double half = 0.2) {
    std::vector<osg::Vec3d> points;
    for (int k = 0; k < 8; ++k)
        points.emplace_back(k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half);
    return points;
}

constexpr unsigned int quads[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};

template <class Elements>
osg::ref_ptr<osg::PrimitiveSet> elements(GLenum mode, std::vector<unsigned int> indices) {
    osg::ref_ptr<Elements> set = new Elements(mode);
    for (unsigned int index : indices) set->push_back(static_cast<typename Elements::value_type>(index));
    return set;
}

inline std::vector<unsigned int> allQuads() {
    return {quads, quads + 24};
}

inline osg::ref_ptr<osg::Geometry> geometry(osg::Array* vertices) {
    osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
    made->setVertexArray(vertices);
    osg::ref_ptr<osg::Vec4Array> colour = new osg::Vec4Array;
    colour->push_back(osg::Vec4(1, 0.5f, 0, 1));
    made->setColorArray(colour, osg::Array::BIND_OVERALL);
    return made;
}

template <class Array>
osg::ref_ptr<osg::Array> points() {
    osg::ref_ptr<Array> array = new Array;
    for (const osg::Vec3d& p : corners()) array->push_back(typename Array::ElementDataType(p));
    return array;
}

/// Integers count tenths; the cube is drawn below a scale.
template <class Array>
osg::ref_ptr<osg::Array> tenths() {
    osg::ref_ptr<Array> array = new Array;
    for (const osg::Vec3d& p : corners(2)) {
        typename Array::ElementDataType point;
        for (int k = 0; k < 3; ++k) point[k] = typename Array::ElementDataType::value_type(p[k]);
        array->push_back(point);
    }
    return array;
}

template <>
inline osg::ref_ptr<osg::Array> points<osg::Vec4Array>() {
    osg::ref_ptr<osg::Vec4Array> array = new osg::Vec4Array;
    for (const osg::Vec3d& p : corners()) array->push_back(osg::Vec4(osg::Vec3(p * 2), 2));
    return array;
}

inline osg::ref_ptr<osg::Geometry> cube(osg::PrimitiveSet* primitives, osg::Array* vertices = nullptr) {
    const auto made = geometry(vertices ? vertices : points<osg::Vec3Array>().get());
    made->addPrimitiveSet(primitives);
    return made;
}

/// Solid cubes all, stored in all the ways there are.
inline std::vector<std::pair<std::string, osg::ref_ptr<osg::Geometry>>> cubes() {
    osg::ref_ptr<osg::Vec3Array> unshared = new osg::Vec3Array, strip = new osg::Vec3Array;
    for (unsigned int index : quads) unshared->push_back(osg::Vec3(corners()[index]));
    // Round the sides, then both lids.
    for (unsigned int index : {0u, 4u, 1u, 5u, 3u, 7u, 2u, 6u, 0u, 4u, 0u, 2u, 3u, 1u, 4u, 5u, 7u, 6u})
        strip->push_back(osg::Vec3(corners()[index]));
    const auto lids = cube(new osg::DrawArrays(GL_QUAD_STRIP, 0, 10), strip);
    osg::ref_ptr<osg::DrawArrayLengths> lengths = new osg::DrawArrayLengths(GL_POLYGON, 10);
    lengths->push_back(4);
    lengths->push_back(4);
    lids->addPrimitiveSet(lengths);
    const auto fans =
        cube(elements<osg::DrawElementsUInt>(GL_TRIANGLE_STRIP, {0, 4, 1, 5, 3, 7, 2, 6, 0, 4}));
    fans->addPrimitiveSet(elements<osg::DrawElementsUShort>(GL_TRIANGLE_FAN, {0, 2, 3, 1}));
    fans->addPrimitiveSet(elements<osg::DrawElementsUByte>(GL_TRIANGLE_FAN, {4, 5, 7, 6}));
    return {
        {"QuadsByte", cube(elements<osg::DrawElementsUByte>(GL_QUADS, allQuads()))},
        {"QuadsShort", cube(elements<osg::DrawElementsUShort>(GL_QUADS, allQuads()))},
        {"QuadsInt", cube(elements<osg::DrawElementsUInt>(GL_QUADS, allQuads()))},
        {"QuadsArrays", cube(new osg::DrawArrays(GL_QUADS, 0, 24), unshared)},
        {"StripAndPolygons", lids},
        {"StripAndFans", fans},
        {"Doubles", cube(elements<osg::DrawElementsUByte>(GL_QUADS, allQuads()), points<osg::Vec3dArray>())},
        {"Weighted", cube(elements<osg::DrawElementsUByte>(GL_QUADS, allQuads()), points<osg::Vec4Array>())},
    };
}

/// The same in whole tenths.
inline std::vector<std::pair<std::string, osg::ref_ptr<osg::Geometry>>> cubesInTenths() {
    const auto of = [](osg::Array* vertices) {
        return cube(elements<osg::DrawElementsUByte>(GL_QUADS, allQuads()), vertices);
    };
    return {{"Bytes", of(tenths<osg::Vec3bArray>())},
            {"Shorts", of(tenths<osg::Vec3sArray>())},
            {"Ints", of(tenths<osg::Vec3iArray>())}};
}

/// Geometry without any triangle.
inline std::vector<std::pair<std::string, osg::ref_ptr<osg::Node>>> nothings() {
    const auto lines = cube(elements<osg::DrawElementsUByte>(GL_LINES, {0, 1, 2, 3}));
    lines->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 8));
    lines->addPrimitiveSet(new osg::DrawArrays(GL_LINE_STRIP, 0, 8));
    osg::ref_ptr<osg::Geometry> bare = new osg::Geometry;
    bare->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    osg::ref_ptr<osg::MatrixTransform> flat = new osg::MatrixTransform(osg::Matrixd::scale(0, 0, 0));
    flat->addChild(nodes::box(osg::Vec3()));
    return {{"Lines", lines},
            {"NoVertices", bare},
            {"NoPrimitives", geometry(points<osg::Vec3Array>())},
            {"EmptyGeode", new osg::Geode},
            {"EmptyLod", new osg::LOD},
            {"EmptySwitch", new osg::Switch},
            {"EmptySequence", new osg::Sequence},
            {"EmptyPagedLod", new osg::PagedLOD},
            {"EmptyProxy", new osg::ProxyNode},
            {"ScaledToNothing", flat}};
}

/// Nodes that show what hangs below in a way of their own; what is below is a cube.
inline std::vector<std::pair<std::string, osg::ref_ptr<osg::Group>>> holders() {
    osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    osg::ref_ptr<osg::Sequence> sequence = new osg::Sequence;
    osg::ref_ptr<osgSim::MultiSwitch> several = new osgSim::MultiSwitch;
    osg::ref_ptr<osg::ProxyNode> proxy = new osg::ProxyNode;
    return {{"Switch", new osg::Switch}, {"Lod", lod},     {"Sequence", sequence},
            {"MultiSwitch", several},    {"Proxy", proxy}, {"Group", new osg::Group}};
}

/// Drawn before the eye or turned to it: no part of any body.
inline std::vector<std::pair<std::string, osg::ref_ptr<osg::Group>>> beforeTheEye() {
    osg::ref_ptr<osg::Camera> hud = new osg::Camera;
    hud->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    hud->setRenderOrder(osg::Camera::POST_RENDER);
    osg::ref_ptr<osg::MatrixTransform> absolute = new osg::MatrixTransform;
    absolute->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    osg::ref_ptr<osg::AutoTransform> turned = new osg::AutoTransform;
    turned->setAutoRotateMode(osg::AutoTransform::ROTATE_TO_SCREEN);
    osg::ref_ptr<osg::Projection> projection = new osg::Projection(osg::Matrixd::ortho2D(0, 1, 0, 1));
    return {{"Hud", hud},
            {"Absolute", absolute},
            {"Turned", turned},
            {"Projection", projection},
            {"Billboard", new osg::Billboard}};
}

/// Turns by a quarter of a circle about Z, at 2 from its own centre.
inline osg::ref_ptr<osgSim::DOFTransform> arm(const std::string& name, osg::Node* load) {
    const auto node = nodes::dof(name);
    node->setMaxHPR(osg::Vec3(1.5f, 0, 0));
    osg::ref_ptr<osg::MatrixTransform> out = new osg::MatrixTransform(osg::Matrixd::translate(2, 0, 0));
    out->addChild(load);
    node->addChild(out);
    return node;
}

} // namespace odd
