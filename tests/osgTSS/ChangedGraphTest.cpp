// What an application changes in a graph with tables so that nodes and their names stay: vertices, what
// stands above a joint, what moves a part.
#include "Files.h"
#include "Heard.h"
#include "Nodes.h"
#include "Playback.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgTSS/Bake>
#include <osgTSS/Install>

using namespace osgTSS;

namespace {

osg::ref_ptr<osg::Vec3Array> cornersFrom(float from) {
    const osg::Vec3 points[] = {{from, 0, 0}, {5, 0.5f, 0}, {5, 0, 0.5f}, {5, -0.5f, -0.5f}};
    return new osg::Vec3Array(4, points);
}

/// A block at 5 that stops a slide at 4, and a tetrahedron of the block's body.
struct ChangedYard {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> block = new osg::MatrixTransform;
    osg::ref_ptr<osg::ShapeDrawable> shape = new osg::ShapeDrawable(new osg::Box(osg::Vec3(5, 0, 0), 1));
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osgSim::DOFTransform> slide = nodes::dof("Slide");
    Playback playback;

    ChangedYard() {
        root->setName("Yard");
        block->setName("Block");
        geometry->setName("Corners");
        geometry->setVertexArray(cornersFrom(4.6f));
        geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
        block->addChild(shape);
        block->addChild(geometry);
        root->addChild(block);
        slide->setMaxTranslate(osg::Vec3(10, 0, 0));
        slide->addChild(nodes::box(osg::Vec3(), 0.5f));
        root->addChild(slide);
        tss::SceneModel model = nodes::extract(*root);
        nodes::giveTable(model, 0, osg::Vec3(5, 0, 0), osg::Vec3(), 0.5);
        REQUIRE(osgTSS::install(*root, model).joints == 1);
        playback.frames(*root, 0, 130);
    }

    /// How often something is warned of in the next updates.
    std::size_t told(const std::string& words) {
        const Heard heard;
        playback.frames(*root, 131, 330);
        return heard.times(words);
    }
};

const std::string otherThanThen = "is other than when tables were installed";

/// Carries what it hangs on a little farther in every update.
struct Drift : osg::Callback {
    bool run(osg::Object* object, osg::Object* data) override {
        auto* node = static_cast<osg::MatrixTransform*>(object);
        node->setMatrix(node->getMatrix() * osg::Matrix::translate(-0.01, 0, 0));
        return traverse(object, data);
    }
};

} // namespace

TEST_CASE("vertices of a body that change are told of, though they are as many as before") {
    ChangedYard yard;
    SECTION("none") {
        CHECK(yard.told(otherThanThen) == 0);
    }
    SECTION("other vertices in the same array, which is said to be dirty") {
        auto& vertices = static_cast<osg::Vec3Array&>(*yard.geometry->getVertexArray());
        vertices[0].x() = 3;
        vertices.dirty();
        CHECK(yard.told(otherThanThen) == 1);
    }
    SECTION("another array") {
        yard.geometry->setVertexArray(cornersFrom(3));
        CHECK(yard.told(otherThanThen) == 1);
    }
    SECTION("other primitive sets over the same vertices") {
        yard.geometry->setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLES, 0, 3));
        CHECK(yard.told(otherThanThen) == 1);
    }
    SECTION("fewer corners in the same primitive set") {
        static_cast<osg::DrawArrays&>(*yard.geometry->getPrimitiveSet(0)).setCount(3);
        CHECK(yard.told(otherThanThen) == 1);
    }
    SECTION("another shape") {
        yard.shape->setShape(new osg::Box(osg::Vec3(5, 0, 0), 4, 1, 1));
        yard.shape->build();
        CHECK(yard.told(otherThanThen) == 1);
    }
}

TEST_CASE("a joint that is no joint any more for what came above it is told of") {
    ChangedYard yard;
    const osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(osg::Matrix::scale(2, 1, 1));
    above->addChild(yard.slide);
    yard.root->replaceChild(yard.slide, above);
    CHECK(yard.told(otherThanThen) == 1);
}

TEST_CASE("a part of a body that a callback moves since install is told of") {
    ChangedYard yard;
    yard.block->addUpdateCallback(new Drift);
    CHECK(yard.told("transform \"Block\" stands elsewhere") == 1);
}

TEST_CASE("joints without names are known by what they join, in whatever order they come") {
    const auto arm = [](float size) {
        const osg::ref_ptr<osgSim::DOFTransform> slide = nodes::dof("");
        slide->setMaxTranslate(osg::Vec3(3, 0, 0));
        slide->addChild(nodes::box(osg::Vec3(0, 10 * size, 0), size));
        return slide;
    };
    const auto yard = [&](const std::vector<float>& sizes) {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->setName("Yard");
        for (const float size : {0.2f, 0.3f}) root->addChild(nodes::box(osg::Vec3(2, 10 * size, 0), size));
        for (const float size : sizes) root->addChild(arm(size));
        return root;
    };
    const std::string cache = (files::scratch() / "nameless.tss").string();
    std::filesystem::remove(cache);
    const BakeOptions options("tolerance=0.1 cache=" + cache);
    const osg::ref_ptr<osg::Group> first = yard({0.2f, 0.3f}), swapped = yard({0.3f, 0.2f});
    const osg::ref_ptr<Scene> baked = bake(*first, options);
    REQUIRE(install(*first, *baked).joints == 2);
    const Heard heard;
    bake(*swapped, options);
    CHECK(heard.times("2 of 2 pairs and skins are as baked") == 1);
    const Installed installed = install(*swapped, *baked);
    CHECK(installed.joints == 2);
    CHECK(installed.stale == 0);
    CHECK(heard.times("osgTSS: pair") == 0);
}
