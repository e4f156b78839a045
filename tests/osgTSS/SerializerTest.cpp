#include "Files.h"
#include "Heard.h"

#include <catch2/catch.hpp>
#include <osg/Geometry>
#include <osgTSS/JointTransform>
#include <osgTSS/SkinGeometry>

TEST_CASE("through .osgt, .osgb and .osgx the states stay the same at the same frames") {
    const auto states = files::states(*files::load(files::saveHinge()));
    for (const std::string extension : {"osgt", "osgb", "osgx"}) {
        CAPTURE(extension);
        const auto file = files::scratch() / ("hinge." + extension);
        REQUIRE(osgDB::writeNodeFile(*files::load(files::saveHinge()), file.string()));
        const osg::ref_ptr<osg::Node> again = files::load(file, "");
        REQUIRE(again);
        CHECK(states == files::states(*again));
        SECTION("and back to .tss from " + extension) {
            const auto back = files::scratch() / ("back-" + extension + ".tss");
            REQUIRE(osgDB::writeNodeFile(*again, back.string()));
            CHECK(states == files::states(*files::load(back)));
        }
    }
}

TEST_CASE("a joint built by hand comes back from .osgt bit for bit, with what it was doing") {
    files::usePlugins();
    osg::ref_ptr<osgTSS::JointTransform> joint = new osgTSS::JointTransform;
    joint->setName("Boom");
    joint->setFrames(osg::Matrixd::rotate(0.1, 1, 2, 3) * osg::Matrixd::translate(1. / 3, 0, 1),
                     osg::Matrixd::translate(0, 1e-9, 7));
    joint->addTranslation('X', -1. / 7, 2, 0.1);
    joint->addRotation('Z', -1, 1.0 / 3);
    joint->setValue(0, 1.1);
    joint->setValue(1, 0.3);
    joint->setResolvedValues({0.2, 0.1});
    const auto file = files::scratch() / "joint.osgt";
    REQUIRE(osgDB::writeNodeFile(*joint, file.string()));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file.string());
    auto* again = dynamic_cast<osgTSS::JointTransform*>(read.get());
    REQUIRE(again);
    CHECK(again->getName() == "Boom");
    CHECK(again->getValues() == joint->getValues());
    CHECK(again->getAskedValues() == joint->getAskedValues());
    CHECK(again->getDof(0).lower == -1. / 7);
    CHECK(again->getWorldMatrices().at(0) == joint->getWorldMatrices().at(0));
}

TEST_CASE("what the old formats lose is named") {
    const osg::ref_ptr<osg::Node> root = files::load(files::saveHinge());
    REQUIRE(root);
    for (const std::string format : {".osg", ".ive"}) {
        CAPTURE(format);
        const Heard heard;
        REQUIRE(osgDB::writeNodeFile(*root, (files::scratch() / ("old" + format)).string()));
        CHECK(heard.times("JointTransform \"Hinge\" is lost in an " + format + " file") == 1);
        CHECK(heard.times("LimitsCallback is lost in an " + format + " file") == 1);
    }
    const Heard heard;
    REQUIRE(osgDB::writeNodeFile(*osg::ref_ptr<osg::Node>(new osg::Group),
                                 (files::scratch() / "none.ive").string()));
    CHECK(heard.times("is lost") == 0);
}

TEST_CASE("a skin comes back from .osgb with its shape at rest") {
    files::usePlugins();
    osg::ref_ptr<osg::Geometry> rest = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(3), normals = new osg::Vec3Array(3);
    std::fill(normals->begin(), normals->end(), osg::Vec3(0, 0, 1));
    (*vertices)[1] = osg::Vec3(1, 0, 0);
    (*vertices)[2] = osg::Vec3(0, 1, 0);
    rest->setVertexArray(vertices);
    rest->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    rest->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    osg::ref_ptr<osgTSS::SkinGeometry> skin = new osgTSS::SkinGeometry;
    skin->setRestGeometry(rest);
    skin->setPath("/Head/Skin");
    const auto file = files::scratch() / "skin.osgb";
    REQUIRE(osgDB::writeNodeFile(*skin, file.string()));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file.string());
    auto* again = dynamic_cast<osgTSS::SkinGeometry*>(read.get());
    REQUIRE(again);
    CHECK(again->getPath() == "/Head/Skin");
    REQUIRE(again->getVertices());
    CHECK((*again->getVertices())[1] == osg::Vec3(1, 0, 0));
    CHECK(again->getBoundingBox().yMax() == 1);
}
