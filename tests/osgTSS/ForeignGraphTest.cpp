#include "Files.h"
#include "Heard.h"
#include "Nodes.h"

#include <osg/AnimationPath>
#include <osg/PositionAttitudeTransform>
#include <osg/ValueObject>
#include <osgTSS/Bake>
#include <osgTSS/SceneFile>

using namespace osgTSS;
using namespace files;
using namespace nodes;

namespace {

/// Turns by a quarter about Z.
osg::ref_ptr<osgSim::DOFTransform> hinge(const std::string& name) {
    const auto node = dof(name);
    node->setMaxHPR(osg::Vec3(1.5f, 0, 0));
    node->addChild(box(osg::Vec3(2, 0, 0)));
    return node;
}

osg::ref_ptr<osg::Geometry> triangles(const std::vector<osg::Vec3>& points) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array(points.begin(), points.end()));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(points.size())));
    return geometry;
}

} // namespace

TEST_CASE("a DYNAMIC transform moves nothing by itself: joints on both sides of it make one chain") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(box(osg::Vec3(0, 0, -1)));
    const auto turret = hinge("Turret"), gun = hinge("Gun");
    osg::ref_ptr<osg::MatrixTransform> between = new osg::MatrixTransform(osg::Matrixd::translate(0, 0, 1));
    between->setDataVariance(osg::Object::DYNAMIC);
    root->addChild(turret);
    turret->addChild(between);
    between->addChild(gun);
    const tss::SceneModel model = extract(*root, ConstraintVisitor::ALL);
    CHECK(model.bodies.size() == 3);
    CHECK(model.joints.size() == 2);
    CHECK(model.pairs.size() == 3);
    CHECK(model.joints[1].frame0.translation().z() == 1);

    SECTION("unless it is said to move") {
        between->setUserValue("osgTSS:moved", true);
        CHECK(extract(*root, ConstraintVisitor::ALL).bodies.size() == 4);
    }
    SECTION("a joint that is said to stand still is none") {
        gun->setUserValue("osgTSS:static", true);
        CHECK(extract(*root, ConstraintVisitor::ALL).joints.size() == 1);
    }
}

TEST_CASE("a rotation written with five digits is a rotation") {
    osg::Matrixd put = osg::Matrixd::rotate(0.7, osg::Vec3d(1, 2, 3)) * osg::Matrixd::translate(1, 2, 3);
    osg::Matrixd rounded = put;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            rounded(row, column) = std::round(put(row, column) * 1e5) / 1e5;
    const auto node = hinge("Arm");
    node->setPutMatrix(rounded);
    node->setInversePutMatrix(osg::Matrixd::inverse(put));
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(rounded);
    above->addChild(node);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(box(osg::Vec3()));
    root->addChild(above);
    const tss::SceneModel model = extract(*root);
    REQUIRE(model.joints.size() == 1);
    CHECK(model.pairs.size() == 1);
    const Eigen::Matrix3d turn = model.joints[0].frame0.linear();
    CHECK((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
}

TEST_CASE(
    "a shear, a corner that is no number and a winding path to be crossed backwards cost themselves alone") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("Yard");
    root->addChild(box(osg::Vec3()));
    root->addChild(hinge("Good"));

    osg::ref_ptr<osg::MatrixTransform> shear = new osg::MatrixTransform(osg::Matrixd::scale(1, 2, 1));
    shear->addChild(hinge("Sheared"));
    root->addChild(shear);

    const auto broken = hinge("Broken");
    const float none = std::numeric_limits<float>::quiet_NaN();
    broken->addChild(triangles({{0, 0, 0}, {1, 0, 0}, {0, none, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    root->addChild(broken);

    osg::ref_ptr<osg::MatrixTransform> along = new osg::MatrixTransform;
    along->setName("Along");
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->insert(0, osg::AnimationPath::ControlPoint(osg::Vec3d(0, 0, 0)));
    path->insert(1, osg::AnimationPath::ControlPoint(osg::Vec3d(5, 0, 0), osg::Quat(1, osg::Vec3d(0, 0, 1))));
    along->setUpdateCallback(new osg::AnimationPathCallback(path));
    along->addChild(box(osg::Vec3(0, 0, 1)));
    root->addChild(along);
    root->addChild(hinge("Last"));

    const tss::SceneModel model = extract(*root, ConstraintVisitor::ALL);
    std::vector<std::string> joints;
    for (const tss::Joint& joint : model.joints) joints.push_back(joint.path);
    CHECK(joints == std::vector<std::string>{"/Yard/Good", "/Yard/Broken", "/Yard/Along", "/Yard/Last"});
    std::vector<std::string> pairs;
    for (const tss::Pair& pair : model.pairs)
        pairs.push_back(model.bodies[pair.bodyA].path + " " + model.bodies[pair.bodyB].path);
    // Against the yard and each other, but nothing of Broken, and from Along to Last only backwards: none.
    const std::vector<std::string> expected{"/Yard/YardBody /Yard/GoodBody", "/Yard/YardBody /Yard/AlongBody",
                                            "/Yard/GoodBody /Yard/AlongBody", "/Yard/YardBody /Yard/LastBody",
                                            "/Yard/GoodBody /Yard/LastBody"};
    CHECK(pairs == expected);
    for (const tss::Body& body : model.bodies)
        for (const tss::Vec3& vertex : body.mesh.vertices) CHECK(vertex.allFinite());
}

TEST_CASE("a DOFTransform with a scale of 0 costs itself alone") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(box(osg::Vec3()));
    const auto flat = hinge("Flat");
    flat->setCurrentScale(osg::Vec3());
    root->addChild(flat);
    root->addChild(hinge("Good"));
    const tss::SceneModel model = extract(*root);
    CHECK(model.joints.size() == 1);
    CHECK(model.pairs.size() == 1);
}

TEST_CASE(
    "a table that says contact where its joint rests is named and not used: the joint stays where it is") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(box(osg::Vec3(0, 0, 0), 0.5f));
    const auto slide = dof("Slide");
    slide->setMinTranslate(osg::Vec3(-0.5f, 0, 0));
    slide->setMaxTranslate(osg::Vec3(3, 0, 0));
    slide->addChild(box(osg::Vec3(1.02f, 0, 0), 0.5f)); // 0.02 apart at rest
    root->addChild(slide);
    const std::string file = (files::scratch() / "pushing.tss").string();
    std::filesystem::remove(file);
    const BakeOptions options("tolerance=0.02 cache=" + file);
    const osg::ref_ptr<Scene> fine = bake(*root, options);
    CHECK(install(*root, *fine).joints == 1);
    tss::SceneModel kept = tss::loadScene(file); // as a budget that ends early leaves it
    auto coarse = std::make_shared<tss::Table>(*kept.pairs.at(0).table);
    for (tss::Sphere& sphere : coarse->a) sphere.radius = static_cast<float>(sphere.radius + 0.5);
    kept.pairs[0].table = coarse;
    tss::saveScene(kept, file);
    const Heard heard;
    const osg::ref_ptr<Scene> pushing = bake(*root, options);
    CHECK(heard.times("Slide is not kept apart: its table says contact where the joint rests") == 1);
    CHECK(install(*root, *pushing).joints == 0);
    Playback playback;
    playback.frame(*root, 0);
    CHECK(slide->getCurrentTranslate() == osg::Vec3());
}

namespace {

/// A box that slides along X towards one at 3, which it meets at 2.
struct Slide {
    osg::ref_ptr<osg::MatrixTransform> root;
    osg::ref_ptr<osgSim::DOFTransform> slide;
    osg::ref_ptr<Scene> scene;
    Playback playback;
    unsigned int frame = 0;

    explicit Slide(const osg::Matrixd& place) : root(new osg::MatrixTransform(place)), slide(dof("Slide")) {
        root->addChild(box(osg::Vec3(3, 0, 0), 0.5f));
        slide->setMaxTranslate(osg::Vec3(5, 0, 0));
        slide->addChild(box(osg::Vec3(), 0.5f));
        root->addChild(slide);
    }
    Installed play() {
        scene = bake(*root, BakeOptions("tolerance=0.05 budget=0.5"));
        return install(*root, *scene);
    }
    float to(float x) {
        slide->setCurrentTranslate(osg::Vec3(x, 0, 0));
        playback.frame(*root, ++frame);
        return static_cast<float>(slide->getCurrentTranslate().x());
    }
};

} // namespace

TEST_CASE("a slide stops at contact under a mirror too") {
    for (const osg::Vec3d& scale : {osg::Vec3d(1, 1, 1), osg::Vec3d(1, -1, 1), osg::Vec3d(-2, 2, 2)}) {
        Slide mirrored(osg::Matrixd::scale(scale));
        CHECK(mirrored.play().joints == 1);
        CHECK(mirrored.to(5) < 2);
        CHECK(mirrored.to(5) > 1.8f);
        CHECK(mirrored.to(1) == 1);
    }
}

TEST_CASE(
    "a machine too far from the root for the floats of a scene is left out, and served below its transform") {
    Slide far(osg::Matrixd::translate(3.9e6, 0.3e6, 5e6));
    osg::ref_ptr<osg::Group> world = new osg::Group;
    world->addChild(far.root);
    Heard heard;
    const osg::ref_ptr<Scene> scene = bake(*world, BakeOptions("tolerance=0.05 budget=0.5"));
    CHECK(install(*world, *scene).joints == 0);
    CHECK(heard.times("coordinates of up to 5e+06 from the root are rounded by 0.59") == 1);
    Slide below{osg::Matrixd()};
    osg::ref_ptr<osg::MatrixTransform> carrier =
        new osg::MatrixTransform(osg::Matrixd::translate(3.9e6, 0.3e6, 5e6));
    carrier->addChild(below.root);
    CHECK(below.play().joints == 1);
    CHECK(below.to(5) < 2);
}

TEST_CASE("a joint that stands at no number at first starts from where it rests") {
    Slide lost{osg::Matrixd()};
    lost.scene = bake(*lost.root, BakeOptions("tolerance=0.05 budget=0.5"));
    const float none = std::numeric_limits<float>::quiet_NaN();
    lost.slide->setCurrentTranslate(osg::Vec3(none, 0, 0));
    CHECK(install(*lost.root, *lost.scene).joints == 1);
    CHECK(lost.to(none) == 0);
    CHECK(lost.to(3) < 2);
}

TEST_CASE("uninstall leaves no scene on an application's graph, and what is written then is the graph") {
    Slide yard{osg::Matrixd()};
    CHECK(yard.play().joints == 1);
    const osg::ref_ptr<osg::MatrixTransform> copy = osg::clone(yard.root.get(), osg::CopyOp::DEEP_COPY_NODES);
    uninstall(*yard.root);
    CHECK(Scene::on(*yard.root) == nullptr);
    CHECK(Scene::on(*copy) == yard.scene);
    yard.root->addChild(box(osg::Vec3(0, 9, 0), 0.5f));
    writeScene(*yard.root, (scratch() / "after.tss").string());
    const osg::ref_ptr<Scene> after = readScene((scratch() / "after.tss").string());
    CHECK_FALSE(after->getModel().pairs.at(0).table);
    CHECK(after->getModel().bodies.at(0).mesh.vertices.size() >
          yard.scene->getModel().bodies.at(0).mesh.vertices.size());
    CHECK(install(*copy, *Scene::on(*copy)).joints == 1); // which holds it alone
}

TEST_CASE("uninstall leaves a graph that was made from a scene its scene") {
    const osg::ref_ptr<osg::Node> made = load(saveHinge());
    REQUIRE(made);
    uninstall(*made);
    CHECK(Scene::on(*made));
}

TEST_CASE("a tagged transform whose matrix is no number stays where it is, and is kept apart after it") {
    const bool attitude = GENERATE(false, true);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(box(osg::Vec3(3, 0, 0), 0.5f));
    osg::ref_ptr<osg::Transform> slide =
        attitude ? static_cast<osg::Transform*>(new osg::PositionAttitudeTransform)
                 : new osg::MatrixTransform;
    slide->setName("Slide");
    slide->setUserValue("osgTSS:dofs", std::string("transX:0:5"));
    slide->addChild(box(osg::Vec3(), 0.5f));
    root->addChild(slide);
    const osg::ref_ptr<Scene> scene = bake(*root, BakeOptions("tolerance=0.05 budget=0.5"));
    REQUIRE(install(*root, *scene).joints == 1);
    Playback playback;
    unsigned int frame = 0;
    const auto to = [&](double x) {
        if (attitude)
            slide->asPositionAttitudeTransform()->setPosition(osg::Vec3d(x, 0, 0));
        else
            slide->asMatrixTransform()->setMatrix(osg::Matrixd::translate(x, 0, 0));
        playback.frame(*root, frame++);
        osg::Matrix now;
        slide->computeLocalToWorldMatrix(now, nullptr);
        return now.getTrans().x();
    };
    CHECK(to(1) == 1);
    for (const double none : {std::nan(""), HUGE_VAL}) CHECK(to(none) == 1);
    playback.frame(*root, frame++); // and nothing brings it back
    CHECK(to(4) < 2);
}

TEST_CASE("a tag of a wrong name or type is told with what was expected, and right ones are not") {
    osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform;
    node->addChild(box(osg::Vec3(), 0.5f));
    node->setUserValue("osgTSS:dof", std::string("rotZ:0:90"));
    node->setUserValue("osgTSS:static", 1);
    node->setUserValue("osgTSS:pivot", osg::Vec3f(1, 0, 0));
    node->setUserValue("ours:dof", 1);
    const Heard heard;
    ConstraintVisitor visitor;
    node->accept(visitor);
    CHECK(visitor.getModel().joints.empty());
    CHECK(heard.times("\"osgTSS:dof\" is none that is known: expected one of osgTSS:dofs, ") == 1);
    CHECK(heard.times("\"osgTSS:static\" is passed over: expected a bool") == 1);
    CHECK(heard.times("user value") == 2);
}

TEST_CASE("a tag whose words have become nonsense lets its joint go, and the update goes on") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(box(osg::Vec3(3, 0, 0), 0.5f));
    osg::ref_ptr<osg::MatrixTransform> slide = new osg::MatrixTransform;
    slide->setName("Slide");
    slide->setUserValue("osgTSS:dofs", std::string("transX:0:5"));
    slide->addChild(box(osg::Vec3(), 0.5f));
    root->addChild(slide);
    const osg::ref_ptr<Scene> scene = bake(*root, BakeOptions("tolerance=0.05 budget=0.5"));
    CHECK(install(*root, *scene).joints == 1);
    slide->setUserValue("osgTSS:dofs", std::string("transX:1:5"));
    Heard heard;
    Playback playback;
    CHECK_NOTHROW(playback.frame(*root, 0));
    CHECK(heard.times("expected limits that hold 0") == 1);
    slide->setMatrix(osg::Matrixd::translate(4, 0, 0));
    playback.frame(*root, 1);
    CHECK(slide->getMatrix().getTrans().x() == 4);
}
