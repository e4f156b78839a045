#include "Playback.h"

#include <catch2/catch.hpp>
#include <osg/FrameStamp>
#include <osg/LineSegment>
#include <osgTSS/CreateGraph>
#include <osgTSS/Install>
#include <osgTSS/SkinGeometry>
#include <osgUtil/CullVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/Optimizer>

using namespace osgTSS;

namespace {

/// The geometry that a cull traversal would draw.
class DrawnBy : public osg::NodeVisitor {
public:
    DrawnBy() : osg::NodeVisitor(CULL_VISITOR, TRAVERSE_ACTIVE_CHILDREN) {}
    void apply(osg::Drawable& drawable) override { drawn = drawable.asGeometry(); }
    osg::Geometry* drawn = nullptr;
};

osg::Geometry* drawnBy(osg::Node& node) {
    DrawnBy visitor;
    node.accept(visitor);
    return visitor.drawn;
}

const osg::Vec3& vertex(const osg::Geometry& geometry, unsigned int i) {
    return static_cast<const osg::Vec3Array&>(*geometry.getVertexArray())[i];
}

osg::ref_ptr<SkinGeometry> triangle() {
    osg::ref_ptr<osg::Geometry> rest = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(3), normals = new osg::Vec3Array(3);
    (*vertices)[1] = osg::Vec3(1, 0, 0);
    (*vertices)[2] = osg::Vec3(0, 1, 0);
    std::fill(normals->begin(), normals->end(), osg::Vec3(0, 0, 1));
    rest->setVertexArray(vertices);
    rest->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    rest->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    osg::ref_ptr<SkinGeometry> skin = new SkinGeometry;
    skin->setRestGeometry(rest);
    return skin;
}

void lift(SkinGeometry& skin, std::uint32_t index, double height) {
    const std::vector<std::uint32_t> indices{index};
    const std::vector<tss::Vec3> positions{tss::Vec3(0, 0, height)}, normals{tss::Vec3(0, 0, 1)};
    skin.deform(indices, positions, normals);
}

} // namespace

TEST_CASE("a vertex that a skin does not have is refused, and nothing is moved") {
    const auto skin = triangle();
    const std::vector<std::uint32_t> indices{0, 3};
    const std::vector<tss::Vec3> two(2, tss::Vec3(0, 0, 1)), one(1, tss::Vec3(0, 0, 1));
    CHECK_THROWS_AS(skin->deform(indices, two, two), std::out_of_range);
    CHECK_THROWS_AS(skin->deform(indices, one, two), std::invalid_argument);
    CHECK_THROWS_AS(skin->deform(two, two), std::invalid_argument);
    CHECK(vertex(*drawnBy(*skin), 0) == osg::Vec3());
    osg::ref_ptr<SkinGeometry> empty = new SkinGeometry;
    CHECK_THROWS_AS(lift(*empty, 0, 1), std::out_of_range);
}

TEST_CASE("what is drawn in one frame is not written in the next") {
    const auto skin = triangle();
    lift(*skin, 0, 1);
    const osg::Geometry* first = drawnBy(*skin);
    REQUIRE(first);
    lift(*skin, 0, 2);
    const osg::Geometry* second = drawnBy(*skin);
    CHECK(second != first);
    CHECK(vertex(*first, 0).z() == 1);
    CHECK(vertex(*second, 0).z() == 2);
    CHECK(first->getVertexArray()->getVertexBufferObject() !=
          second->getVertexArray()->getVertexBufferObject());
}

TEST_CASE("a shape that did not change is drawn from the same buffer, and not sent again") {
    const auto skin = triangle();
    lift(*skin, 0, 1);
    const osg::Geometry* first = drawnBy(*skin);
    const unsigned int sent = first->getVertexArray()->getModifiedCount();
    CHECK(drawnBy(*skin) == first);
    CHECK(first->getVertexArray()->getModifiedCount() == sent);
}

TEST_CASE("the bound holds every shape so far, also seen from above") {
    const auto skin = triangle();
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(skin);
    CHECK(root->getBound().radius() < 1);
    lift(*skin, 0, 10);
    CHECK(root->getBound().contains(osg::Vec3(0.5f, 0.5f, 9.9f)));
    CHECK(drawnBy(*skin)->getBoundingBox().zMax() == 10);
    lift(*skin, 0, 0);
    CHECK(skin->getBoundingBox().zMax() == 10);
}

TEST_CASE("rays hit a skin where it is now") {
    const auto skin = triangle();
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::vector<std::uint32_t> indices{k};
        const osg::Vec3 at = (*skin->getVertices())[k];
        const std::vector<tss::Vec3> positions{tss::Vec3(at.x(), at.y(), 5)}, normals{tss::Vec3(0, 0, 1)};
        skin->deform(indices, positions, normals);
    }
    osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(0.2, 0.2, 9), osg::Vec3d(0.2, 0.2, -9));
    osgUtil::IntersectionVisitor visitor(ray);
    skin->accept(visitor);
    REQUIRE(ray->containsIntersections());
    CHECK(ray->getFirstIntersection().getWorldIntersectPoint().z() == Approx(5));
}

TEST_CASE("copies of a skin have shapes of their own") {
    const auto skin = triangle();
    lift(*skin, 0, 1);
    const osg::ref_ptr<SkinGeometry> copy = osg::clone(skin.get());
    lift(*skin, 0, 2);
    CHECK((*copy->getVertices())[0].z() == 1);
    CHECK((*skin->getVertices())[0].z() == 2);
    CHECK((*skin->getRestGeometry()->getVertexArray()).getNumElements() == 3);
}
