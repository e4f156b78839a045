#include "Heard.h"
#include "Nodes.h"

#include <osgTSS/JointCallback>

using namespace osgTSS;
using namespace nodes;

namespace {

/// Two arms on a yard, each stopped at 4 by a block at 5 of its own.
struct Yard {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<osg::ref_ptr<osgSim::DOFTransform>> arms;
    Playback playback;
    unsigned int frame = 0;

    explicit Yard(float size = 0.5f) {
        root->setName("Yard");
        root->addChild(box(osg::Vec3(5, 0, 0), 0.5f));
        root->addChild(box(osg::Vec3(5, 9, 0), 0.5f));
        for (int k = 0; k < 2; ++k) {
            arms.push_back(dof(k ? "Right" : "Left"));
            arms[k]->setMaxTranslate(osg::Vec3(10, 0, 0));
            arms[k]->addChild(box(osg::Vec3(0, k ? 9.f : 0.f, 0), k ? 0.5f : size));
            root->addChild(arms[k]);
        }
    }
    tss::SceneModel baked() {
        tss::SceneModel model = extract(*root);
        REQUIRE(model.pairs.size() == 2);
        giveTable(model, 0, osg::Vec3(5, 0, 0), osg::Vec3(), 0.5);
        giveTable(model, 1, osg::Vec3(5, 9, 0), osg::Vec3(0, 9, 0), 0.5);
        return model;
    }
    float reach(int k, float asked = 9) {
        arms[k]->setCurrentTranslate(osg::Vec3(asked, 0, 0));
        playback.frame(*root, ++frame);
        return arms[k]->getCurrentTranslate()[0];
    }
};

} // namespace

TEST_CASE("a table is installed where the graph holds what it was made from") {
    Yard baked;
    const tss::SceneModel model = baked.baked();
    SECTION("the same graph again") {
        Yard same;
        same.arms[0]->setCurrentTranslate(osg::Vec3(1, 0, 0)); // has moved since
        const Installed installed = install(*same.root, model);
        CHECK(installed.joints == 2);
        CHECK(installed.stale == 0);
        CHECK(same.reach(0) == Approx(4).margin(1e-3));
    }
    SECTION("other geometry") {
        Yard other(0.4f);
        const Installed installed = install(*other.root, model);
        CHECK(installed.joints == 1);
        CHECK(installed.stale == 1);
        CHECK(other.reach(0) == 9);
        CHECK(other.reach(1) == Approx(4).margin(1e-3));
    }
    SECTION("wider limits") {
        Yard wide;
        wide.arms[1]->setMaxTranslate(osg::Vec3(20, 0, 0));
        CHECK(install(*wide.root, model).stale == 1);
    }
    SECTION("wider limits of a slide that is as short as rounding is elsewhere") {
        Yard shortOne, wide;
        shortOne.arms[1]->setMaxTranslate(osg::Vec3(1e-5f, 0, 0));
        wide.arms[1]->setMaxTranslate(osg::Vec3(1.8e-5f, 0, 0));
        const tss::SceneModel narrow = shortOne.baked();
        CHECK(install(*shortOne.root, narrow).stale == 0);
        CHECK(install(*wide.root, narrow).stale == 1);
    }
    SECTION("narrower ones are within what the table knows") {
        Yard narrow;
        narrow.arms[1]->setMaxTranslate(osg::Vec3(8, 0, 0));
        CHECK(install(*narrow.root, model).stale == 0);
    }
    SECTION("names that were swapped") {
        Yard swapped;
        swapped.arms[0]->setName("Right");
        swapped.arms[1]->setName("Left");
        const Installed installed = install(*swapped.root, model);
        CHECK(installed.joints == 0);
        CHECK(installed.stale == 2);
    }
}

TEST_CASE("two machines of one kind are both served") {
    Yard one, other;
    tss::SceneModel model = one.baked();
    osg::ref_ptr<osg::Group> both = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> aside = new osg::MatrixTransform(osg::Matrixd::translate(0, 50, 0));
    both->addChild(one.root);
    both->addChild(aside);
    aside->addChild(other.root);
    // What hangs together without a joint is one body, so that each yard is asked for alone.
    CHECK(install(*one.root, model).joints == 2);
    CHECK(install(*other.root, model).joints == 2);
    Playback playback;
    for (Yard* yard : {&one, &other}) yard->arms[0]->setCurrentTranslate(osg::Vec3(9, 0, 0));
    playback.frame(*both, 1);
    CHECK(one.arms[0]->getCurrentTranslate()[0] == Approx(4).margin(1e-3));
    CHECK(other.arms[0]->getCurrentTranslate()[0] == Approx(4).margin(1e-3));
}

TEST_CASE("machines that a joint each carries are served in one install") {
    // The pair is of the two parts of each machine, the hull and the arm, both moved by joints.
    const auto machine = [](const std::string& name) {
        const auto hull = dof(name), arm = dof("Arm");
        hull->setMaxHPR(osg::Vec3(1, 0, 0));
        hull->addChild(box(osg::Vec3(5, 0, 0), 0.5f));
        arm->setMaxTranslate(osg::Vec3(10, 0, 0));
        arm->addChild(box(osg::Vec3(), 0.5f));
        hull->addChild(arm);
        return hull;
    };
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("Scene");
    const auto first = machine("Hull"), second = machine("Hull");
    root->addChild(first);
    tss::SceneModel model = extract(*root);
    REQUIRE(model.pairs.size() == 1);
    giveTable(model, 0, osg::Vec3(5, 0, 0), osg::Vec3(), 0.5);
    root->addChild(second);
    CHECK(install(*root, model).joints == 2);
    Playback playback;
    for (const auto& hull : {first, second})
        find<osgSim::DOFTransform>(*hull, "Arm")->setCurrentTranslate({9, 0, 0});
    playback.frame(*root, 1);
    for (const auto& hull : {first, second})
        CHECK(find<osgSim::DOFTransform>(*hull, "Arm")->getCurrentTranslate()[0] == Approx(4).margin(1e-3));
}

namespace {

/// A yard with one callback over both arms, as where they share a joint.
struct YardOfOneCallback : Yard {
    const tss::SceneModel model = baked();
    osg::ref_ptr<Scene> scene = new Scene(std::make_shared<tss::SceneModel>(model));
    osg::ref_ptr<JointCallback> both = new JointCallback(scene, {model.pairs[0].path, model.pairs[1].path});

    YardOfOneCallback() {
        install(*root, *scene);
        uninstall(*root);
        root->setUpdateCallback(both);
        both->start(*root);
        CHECK(reach(0) == Approx(4).margin(1e-3));
    }
};

} // namespace

TEST_CASE("a node that is taken out takes its own pairs along and no others") {
    YardOfOneCallback yard;
    CHECK(yard.reach(1) == Approx(4).margin(1e-3));
    yard.root->removeChild(yard.arms[0]);
    CHECK(yard.reach(1, 1) == 1);
    CHECK(yard.reach(1) == Approx(4).margin(1e-3));

    SECTION("and back where it was it is kept apart again") {
        yard.root->addChild(yard.arms[0]);
        yard.scene->setModel(std::make_shared<tss::SceneModel>(yard.model));
        yard.reach(0, 0);
        CHECK(yard.reach(0) == Approx(4).margin(1e-3));
    }
}

TEST_CASE("a joint that is hung elsewhere is let go, and the others are kept") {
    YardOfOneCallback yard;
    yard.reach(0, 0);
    osg::ref_ptr<osg::MatrixTransform> aside = new osg::MatrixTransform(osg::Matrixd::translate(0, 3, 0));
    yard.root->addChild(aside);
    aside->addChild(yard.arms[0]);
    yard.root->removeChild(yard.arms[0]);
    CHECK(yard.reach(0) == 9);
    CHECK(yard.reach(1) == Approx(4).margin(1e-3));
}

TEST_CASE("what comes after install is told of once, where it may touch a body of a pair") {
    Yard yard;
    install(*yard.root, yard.baked());
    Heard heard;
    const auto told = [&] {
        for (int frame = 0; frame < 130; ++frame) yard.reach(0, 1);
        return heard.times("is other than when tables were installed");
    };
    const auto inGroup = [](const osg::ref_ptr<osg::Node>& node) {
        osg::ref_ptr<osg::MatrixTransform> group = new osg::MatrixTransform;
        group->setName("Later");
        group->addChild(node);
        return group;
    };
    REQUIRE(told() == 0);
    SECTION("below a joint, which carries it against a block") {
        yard.arms[0]->addChild(box(osg::Vec3(1, 0, 0)));
        CHECK(told() == 1);
    }
    SECTION("below a joint, which carries it past all there is") {
        yard.arms[0]->addChild(box(osg::Vec3(1, 4, 0)));
        CHECK(told() == 0);
    }
    SECTION("in the way of a joint") {
        yard.root->addChild(box(osg::Vec3(3, 0, 0)));
        CHECK(told() == 1);
    }
    SECTION("where no joint comes, by more than it is wide") {
        yard.root->addChild(box(osg::Vec3(3, 1, 0)));
        yard.root->addChild(box(osg::Vec3(-0.8f, 0, 0)));
        yard.root->addChild(box(osg::Vec3(11, 9, 0)));
        CHECK(told() == 0);
    }
    SECTION("with a joint of its own, that carries it into the way or not") {
        const bool far = GENERATE(true, false);
        const auto slide = dof("Other");
        slide->setMaxTranslate(osg::Vec3(0, far ? 2.f : 4.f, 0));
        slide->addChild(box(osg::Vec3(3, 4.5f, 0)));
        yard.root->addChild(slide);
        CHECK(told() == (far ? 0 : 1));
    }
    SECTION("on a joint of its own below a joint, that carries it into the way or not") {
        const bool far = GENERATE(true, false);
        const auto slide = dof("Other");
        slide->setMaxTranslate(osg::Vec3(0, far ? 2.f : 4.f, 0));
        slide->addChild(box(osg::Vec3(3, 4.5f, 0)));
        yard.arms[1]->addChild(slide);
        CHECK(told() == (far ? 0 : 1));
    }
    SECTION("on the screen") {
        osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        camera->addChild(box(osg::Vec3(3, 0, 0)));
        yard.root->addChild(camera);
        CHECK(told() == 0);
    }
    SECTION("out of the way at first, and later in it") {
        const auto group = inGroup(box(osg::Vec3(3, 20, 0)));
        yard.root->addChild(group);
        CHECK(told() == 0);
        group->setMatrix(osg::Matrixd::translate(0, -10, 0));
        CHECK(told() == 0);
        CHECK(heard.times("stands elsewhere") == 0);
        group->setMatrix(osg::Matrixd::translate(0, -20, 0));
        told();
        CHECK(heard.times("transform \"Later\" stands elsewhere") == 1);
    }
    SECTION("a group that is empty at first") {
        const auto group = inGroup(new osg::Group);
        yard.root->addChild(group);
        CHECK(told() == 0);
        group->getChild(0)->asGroup()->addChild(box(osg::Vec3(3, 0, 0)));
        CHECK(told() == 1);
    }
    SECTION("gone again") {
        const auto group = inGroup(box(osg::Vec3(3, 20, 0)));
        yard.root->addChild(group);
        CHECK(told() == 0);
        group->removeChild(0u, 1u);
        yard.root->removeChild(group);
        CHECK(told() == 0);
    }
    SECTION("what tables know goes") {
        yard.root->removeChild(0u, 1u);
        CHECK(told() == 1);
    }
}

TEST_CASE("a transform that was taken to stand still and is moved after install is told of once") {
    Yard yard;
    // Above the first arm, below it, and above all there is.
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform, below = new osg::MatrixTransform,
                                       whole = new osg::MatrixTransform;
    above->setName("Above");
    below->setName("Below");
    whole->setName("Whole");
    yard.root->replaceChild(yard.arms[0], above);
    above->addChild(yard.arms[0]);
    const osg::ref_ptr<osg::Node> block = yard.arms[0]->getChild(0);
    yard.arms[0]->replaceChild(block, below);
    below->addChild(block);
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->setName("Yard");
    whole->addChild(yard.root);
    group->addChild(whole);
    yard.root = group;
    const tss::SceneModel model = yard.baked();
    REQUIRE(install(*yard.root, model).joints == 2);
    Heard heard;
    const auto play = [&] {
        for (int frame = 0; frame < 130; ++frame) yard.reach(0, 1);
    };
    play();
    CHECK(heard.times("stands elsewhere") == 0);
    SECTION("between the yard and an arm") {
        above->setMatrix(osg::Matrixd::translate(0, 1, 0));
        play();
        CHECK(heard.times("transform \"Above\" stands elsewhere than when tables were installed") == 1);
    }
    SECTION("between an arm and what it carries") {
        below->setMatrix(osg::Matrixd::rotate(0.1, osg::Vec3d(0, 0, 1)));
        play();
        CHECK(heard.times("transform \"Below\" stands elsewhere") == 1);
    }
    SECTION("what carries all of it may go anywhere") {
        whole->setMatrix(osg::Matrixd::translate(0, 100, 0));
        play();
        CHECK(heard.times("stands elsewhere") == 0);
    }
}

TEST_CASE("what a table does to its joint is said when it is installed, once") {
    Yard yard;
    tss::SceneModel model = yard.baked();
    auto coarse = std::make_shared<tss::Table>(*model.pairs[0].table);
    coarse->epsilon = 4; // 4 units apart at rest
    model.pairs[0].table = coarse;
    Heard heard;
    install(*yard.root, model);
    yard.reach(0, 1);
    yard.reach(1, 1);
    CHECK(heard.times("too coarse") == 1);
}
