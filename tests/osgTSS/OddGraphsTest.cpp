#include "OddGraphs.h"

#include "Files.h"
#include "Heard.h"

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgTSS/Bake>
#include <osgTSS/JointCallback>
#include <osgText/Text>

using namespace osgTSS;
using namespace nodes;

namespace {

const BakeOptions quick("tolerance=0.1 epsilon=0.1 budget=1 cache=off");

/// A yard with a block that an arm's load comes to, at a quarter of a turn less a little.
osg::ref_ptr<osg::Group> yard(osg::Node* load) {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("Yard");
    root->addChild(box(osg::Vec3(0, 2, 0)));
    root->addChild(odd::arm("Arm", load));
    return root;
}

/// How far the arm comes when it is asked to turn by 1.5, little by little.
float reach(osg::Group& root) {
    Playback playback;
    auto& arm = *find<osgSim::DOFTransform>(root, "Arm");
    for (unsigned int frame = 0; frame <= 30; ++frame) {
        arm.setCurrentHPR(osg::Vec3(0.05f * float(frame), 0, 0));
        playback.frame(root, frame);
    }
    return arm.getCurrentHPR().x();
}

} // namespace

TEST_CASE("a cube is the same body whatever its triangles and vertices are stored as") {
    std::vector<std::pair<std::string, osg::ref_ptr<osg::Node>>> cubes;
    for (const auto& [name, cube] : odd::cubes()) cubes.emplace_back(name, cube);
    for (const auto& [name, cube] : odd::cubesInTenths()) {
        cubes.emplace_back(name, new osg::MatrixTransform(osg::Matrixd::scale(0.1, 0.1, 0.1)));
        cubes.back().second->asGroup()->addChild(cube);
    }
    for (const auto& [name, cube] : cubes) {
        CAPTURE(name);
        const osg::ref_ptr<osg::Group> root = yard(cube);
        const tss::SceneModel model = extract(*root);
        REQUIRE(model.pairs.size() == 1);
        const tss::TriangleMesh& mesh = model.bodies[model.pairs[0].bodyB].mesh;
        CHECK(mesh.vertices.size() == 8);
        CHECK(mesh.triangles.size() == 12);
        const Eigen::AlignedBox3d box = tss::bounds(mesh);
        CHECK((box.min() - tss::Vec3(1.8, -0.2, -0.2)).norm() < 1e-6);
        CHECK((box.max() - tss::Vec3(2.2, 0.2, 0.2)).norm() < 1e-6);
    }
}

TEST_CASE("an arm with a cube of any kind stops at what it would go through") {
    for (const auto& [name, cube] : {odd::cubes()[4], odd::cubes()[6]}) {
        CAPTURE(name);
        const osg::ref_ptr<osg::Group> root = yard(cube);
        const Heard heard;
        REQUIRE(install(*root, *bake(*root, quick)).joints == 1);
        const float angle = reach(*root);
        CHECK(angle > 1.1f);
        CHECK(angle < 1.4f);
    }
}

TEST_CASE("indices beyond the vertices cost the pairs of their body, by name") {
    const auto cube = odd::cube(odd::elements<osg::DrawElementsUByte>(GL_QUADS, odd::allQuads()));
    cube->addPrimitiveSet(odd::elements<osg::DrawElementsUInt>(GL_TRIANGLES, {0, 1, 1000000}));
    const osg::ref_ptr<osg::Group> root = yard(cube);
    const Heard heard;
    CHECK(extract(*root).pairs.empty());
    CHECK(heard.times("1 of its triangles have corners that are no numbers or no vertices") == 1);
}

TEST_CASE("what draws nothing solid is no body and costs nothing") {
    for (const auto& [name, nothing] : odd::nothings()) {
        CAPTURE(name);
        const osg::ref_ptr<osg::Group> root = yard(nothing);
        const Heard heard;
        const osg::ref_ptr<Scene> scene = bake(*root, quick);
        install(*root, *scene);
        CHECK(reach(*root) == Approx(1.5));
    }
}

TEST_CASE("text that turns to the eye is no body, and text that does not is one") {
    for (const bool turns : {true, false}) {
        const osg::ref_ptr<osgText::Text> label = new osgText::Text;
        label->setText("label");
        label->setAutoRotateToScreen(turns);
        CHECK(extract(*yard(label)).pairs.size() == (turns ? 0 : 1));
    }
}

TEST_CASE("what is paged in later is no body, and is told of where there are joints") {
    const osg::ref_ptr<osg::PagedLOD> paged = new osg::PagedLOD;
    paged->setName("Tile");
    paged->addChild(odd::cubes()[0].second, 100, 1e9f);
    paged->setRange(1, 0, 100);
    paged->setFileName(1, "finer.osgb");
    const osg::ref_ptr<osg::Group> root = yard(paged), still = new osg::Group;
    still->addChild(paged);
    const Heard heard;
    extract(*still);
    CHECK(heard.times("paged") == 0);
    extract(*root);
    CHECK(heard.times("what is paged in later is part of no body") == 1);
    CHECK(heard.times("/Tile") == 1);
}

TEST_CASE("surface that shaders make is told of where there are joints") {
    const auto told = [](osg::PrimitiveSet* primitives) {
        const osg::ref_ptr<osg::Geometry> drawn = odd::cube(primitives);
        drawn->setName("Terrain");
        const osg::ref_ptr<osg::Group> root = yard(drawn), still = new osg::Group;
        still->addChild(drawn);
        const Heard heard;
        extract(*still);
        CHECK(heard.times("shaders") == 0);
        extract(*root);
        CHECK(heard.times("/Terrain") == heard.times("what shaders make"));
        return heard.times("what shaders make of patches, triangles with adjacency and instances is part of");
    };
    for (const GLenum mode : {osg::PrimitiveSet::PATCHES, osg::PrimitiveSet::TRIANGLES_ADJACENCY,
                              osg::PrimitiveSet::TRIANGLE_STRIP_ADJACENCY}) {
        CHECK(told(new osg::DrawArrays(mode, 0, 6)) == 1);
        CHECK(told(new osg::DrawArrays(mode, 0, 0)) == 0);
    }
    CHECK(told(new osg::DrawArrays(GL_TRIANGLES, 0, 6, 1)) == 0);
    CHECK(told(new osg::DrawArrays(GL_TRIANGLES, 0, 6, 2)) == 1);
    CHECK(told(new osg::DrawArrays(osg::PrimitiveSet::LINES_ADJACENCY, 0, 4)) == 0);
}

TEST_CASE("what holds a cube is looked into, and what is drawn before the eye is not") {
    for (const auto& [name, holder] : odd::holders()) {
        CAPTURE(name);
        if (auto* lod = dynamic_cast<osg::LOD*>(holder.get()))
            lod->addChild(odd::cubes()[0].second, 0, 1000);
        else
            holder->addChild(odd::cubes()[0].second);
        const osg::ref_ptr<osg::Group> root = yard(holder);
        const Heard heard;
        CHECK(extract(*root).pairs.size() == 1);
    }
    for (const auto& [name, before] : odd::beforeTheEye()) {
        CAPTURE(name);
        before->addChild(odd::cubes()[0].second);
        const osg::ref_ptr<osg::Group> root = yard(before);
        const Heard heard;
        CHECK(extract(*root).pairs.empty());
        CHECK(heard.times("it is no joint") == 0);
        if (!before->asTransform()) continue;
        before->setUserValue("osgTSS:dofs", std::string("rotZ:0:90"));
        extract(*root);
        // What a camera draws is looked for by nobody.
        CHECK(heard.times("it is no joint, as it turns to the eye") == (name == "Hud" ? 0 : 1));
    }
}

TEST_CASE(
    "all of it in one graph, shared by two arms, is saved, loaded with .tss behind its name, and plays") {
    osg::ref_ptr<osg::Group> load = new osg::Group;
    for (const auto& [name, cube] : odd::cubes()) load->addChild(cube);
    for (const auto& [name, nothing] : odd::nothings()) load->addChild(nothing);
    for (const auto& [name, before] : odd::beforeTheEye()) {
        before->addChild(odd::cubes()[0].second);
        load->addChild(before);
    }
    const osg::ref_ptr<osg::Group> root = yard(load);
    root->addChild(odd::arm("Other", load)); // through the first, at rest
    const std::string file = (files::scratch() / "odd.osgt").string();
    const Heard heard;
    REQUIRE(osgDB::writeNodeFile(*root, file));
    const osg::ref_ptr<osg::Node> back = osgDB::readRefNodeFile(
        file + ".tss", new osgDB::Options("tolerance=0.1 epsilon=0.1 budget=1 cache=off"));
    REQUIRE(back);
    const float angle = reach(*back->asGroup());
    CHECK(angle > 1.1f);
    CHECK(angle < 1.4f);
}

TEST_CASE(
    "a joint that a callback takes out in the middle of a traversal takes its pairs along, and no more") {
    struct TakeOut : osg::NodeCallback {
        void operator()(osg::Node* node, osg::NodeVisitor* visitor) override {
            osg::Group& group = *node->asGroup();
            if (visitor->getFrameStamp()->getFrameNumber() == 20)
                group.removeChild(find<osgSim::DOFTransform>(group, "Arm"));
            traverse(node, visitor);
            if (visitor->getFrameStamp()->getFrameNumber() == 25)
                group.removeChildren(0, group.getNumChildren());
        }
    };
    const osg::ref_ptr<osg::Group> root = yard(odd::cubes()[0].second);
    const osg::ref_ptr<osgSim::DOFTransform> other = odd::arm("Other", odd::cubes()[1].second);
    root->addChild(other);
    const Heard heard;
    REQUIRE(install(*root, *bake(*root, quick)).joints == 2);
    root->addUpdateCallback(new TakeOut);
    Playback playback;
    auto& arm = *find<osgSim::DOFTransform>(*root, "Arm");
    const osg::ref_ptr<osg::Node> keep = &arm;
    for (unsigned int frame = 0; frame <= 30; ++frame) {
        arm.setCurrentHPR(osg::Vec3(0.05f * float(frame), 0, 0));
        other->setCurrentHPR(osg::Vec3(0.075f * float(frame), 0, 0));
        playback.frame(*root, frame);
        if (frame == 24) CHECK(other->getCurrentHPR().x() < 1.4f);
    }
    CHECK(arm.getCurrentHPR().x() == Approx(1.5));
}
