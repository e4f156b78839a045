#include "InstallSkins.h"

#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/NodePaths.h"
#include "osgTSS/src/draw/BodyNodes.h"
#include "osgTSS/src/extract/FindQuietly.h"
#include "osgTSS/src/extract/SoftParts.h"
#include "osgTSS/src/extract/SoftTags.h"

#include "bake/model/SourceHash.h"
#include "bake/model/UnderSkin.h"
#include "bake/scene/SceneLayer.h"

#include <osg/Notify>
#include <osg/ValueObject>
#include <osgAnimation/RigTransformHardware>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/MuscleCallback>
#include <osgTSS/SkinCallback>

#include <algorithm>
#include <memory>
#include <set>

namespace osgTSS {

namespace {

/// What a drawable is drawn with; of a mesh that hardware deforms without what deforms it.
osg::ref_ptr<osg::StateSet> stateOf(osg::Drawable& drawable, osg::Geometry& source) {
    const osg::ref_ptr<osg::StateSet> state =
        drawable.getStateSet() ? drawable.getStateSet() : source.getStateSet();
    auto* rig = dynamic_cast<osgAnimation::RigGeometry*>(&drawable);
    auto* hardware =
        rig ? dynamic_cast<osgAnimation::RigTransformHardware*>(rig->getRigTransformImplementation())
            : nullptr;
    if (!state || !hardware || !hardware->getMatrixPaletteUniform()) return state;
    osg::ref_ptr<osg::StateSet> plain = osg::clone(state.get(), osg::CopyOp::SHALLOW_COPY);
    plain->removeAttribute(osg::StateAttribute::PROGRAM);
    plain->removeUniform(hardware->getMatrixPaletteUniform());
    return plain;
}

/// Shows what the drawable shows, its state and all its other arrays kept, and lets its vertices be moved.
osg::ref_ptr<SkinGeometry> shownInsteadOf(osg::Drawable& drawable, const std::string& body, double scale) {
    const osg::ref_ptr<osg::Geometry> keep = restGeometryOf(drawable);
    osg::Geometry& source = *keep;
    osg::ref_ptr<osg::Geometry> rest = new osg::Geometry(source, osg::CopyOp::SHALLOW_COPY);
    if (rest->containsDeprecatedData()) {
        rest = new osg::Geometry(source, osg::CopyOp::DEEP_COPY_ARRAYS | osg::CopyOp::DEEP_COPY_PRIMITIVES);
        rest->fixDeprecatedData();
    }
    rest->setUserDataContainer(nullptr);
    osg::ref_ptr<SkinGeometry> shown = new SkinGeometry;
    shown->setRestGeometry(rest);
    shown->setName(drawable.getName());
    shown->setNodeMask(drawable.getNodeMask());
    shown->setCullingActive(drawable.getCullingActive());
    shown->setCullCallback(drawable.getCullCallback());
    shown->setStateSet(stateOf(drawable, source));
    if (const osg::UserDataContainer* container = drawable.getUserDataContainer())
        shown->setUserDataContainer(osg::clone(container, osg::CopyOp::DEEP_COPY_USERDATA));
    osg::UserDataContainer& values = *shown->getOrCreateUserDataContainer();
    values.removeUserObject(values.getUserObjectIndex(activationTag)); // what is written there is new
    values.addUserObject(&drawable);
    shown->setPath(body);
    tagBody(*shown, body, scale);
    return shown;
}

/// The groups of the graph below root that hold the drawable; copies of the graph may hold it too.
std::vector<osg::Group*> parentsBelow(osg::Node& root, osg::Drawable& drawable) {
    std::vector<osg::Group*> parents;
    for (osg::Group* parent : drawable.getParents())
        if (isBelow(*parent, root)) parents.push_back(parent);
    return parents;
}

/// A mesh of morph targets stays where what sets its weights looks for it, and is not drawn.
void replace(osg::Node& root, osg::Drawable& before, osg::Drawable& after) {
    const osg::ref_ptr<osg::Drawable> keep = &before;
    const bool stays = dynamic_cast<osgAnimation::MorphGeometry*>(&before);
    for (osg::Group* parent : parentsBelow(root, before))
        if (stays)
            parent->insertChild(parent->getChildIndex(&before) + 1, &after);
        else
            parent->replaceChild(&before, &after);
    if (!stays) return;
    before.setNodeMask(0);
    before.setUserValue("osgTSS:ignored", true);
}

void putBack(osg::Node& root, SkinGeometry& shown) {
    const osg::ref_ptr<osg::Drawable> before = replacedBy(shown), keep = &shown;
    if (!dynamic_cast<osgAnimation::MorphGeometry*>(before.get())) return replace(root, shown, *before);
    before->setNodeMask(shown.getNodeMask());
    before->setUserValue("osgTSS:ignored", false);
    for (osg::Group* parent : parentsBelow(root, shown)) parent->removeChild(&shown);
}

/// A graph's own skins and muscles, as a visitor finds them.
class OwnSkins {
public:
    OwnSkins(osg::Node& root, Scene& scene, bool activeOnly)
        : _root(root), _scene(scene), _model(scene.getModel()),
          _bodies(findQuietly(root, _visitor, activeOnly).bodies),
          _found(tss::readScene(tss::toLayer(_visitor.getModel()), "the graph")) {}

    /// Why the graph does not hold what the skin was made from; empty: it does, and shows it from now on.
    std::string show(int index) {
        const tss::SkinModel& skin = _model.skins[index];
        const int other = tss::findSkin(_found, skin.path);
        if (other < 0) return "nothing in the graph is tagged as this skin";
        tss::SkinModel now = _found.skins[other];
        now.settings = skin.settings;
        const std::string stored = skin.sourceHash.empty() ? tss::sourceHash(_model, skin) : skin.sourceHash;
        if (tss::sourceHash(_found, now) != stored)
            return "the graph holds another mesh, other bones or muscles than it was made from";
        const osg::ref_ptr<SkinGeometry> drawn = put(skin.body, now.body);
        for (std::size_t k = 0; k < skin.muscles.size(); ++k) {
            const tss::MuscleModel& muscle = _model.muscles[skin.muscles[k]];
            const osg::ref_ptr<SkinGeometry> shown = put(muscle.body, _found.muscles[now.muscles[k]].body);
            if (shown && !shown->getUpdateCallback() && muscle.insertionBone < 0)
                shown->addUpdateCallback(new MuscleCallback(&_scene, muscle.path));
        }
        const auto under = tss::underSkin(_model, skin), here = tss::underSkin(_found, now);
        const std::string carrier = drawn ? carrierOf(*drawn) : "";
        for (std::size_t k = 0; k < under.size(); ++k) {
            tag(under[k].bone, here[k].bone);
            if (under[k].bone >= 0 && here[k].bone >= 0 && carrier == _found.bodies[here[k].bone].path)
                tagCarrier(*drawn, _model.bodies[under[k].bone].path);
        }
        return "";
    }

private:
    /// Null where it stands there already.
    osg::ref_ptr<SkinGeometry> put(int body, int foundBody) {
        const ConstraintVisitor::BodyNode at = nodeOf(foundBody);
        auto* drawable = dynamic_cast<osg::Drawable*>(at.node);
        if (!drawable || !_shown.insert(drawable).second) return nullptr;
        const osg::ref_ptr<SkinGeometry> shown =
            shownInsteadOf(*drawable, _model.bodies[body].path, at.scale);
        replace(_root, *drawable, *shown);
        return shown;
    }

    void tag(int body, int foundBody) const {
        if (body < 0 || foundBody < 0) return;
        const ConstraintVisitor::BodyNode at = nodeOf(foundBody);
        if (at.node) tagBody(*at.node, _model.bodies[body].path, at.scale);
    }

    /// The body of the graph that a drawable hangs in.
    std::string carrierOf(osg::Drawable& drawable) const {
        const osg::NodePathList paths = pathsFrom(_root, drawable);
        std::string carrier = _bodies.front().path; // what no joint moves
        if (paths.empty()) return carrier;
        for (const osg::Node* at : paths.front())
            for (std::size_t b = 0; b < _bodies.size(); ++b)
                if (_visitor.getBodyNodes()[b].node == at && at != &drawable) carrier = _bodies[b].path;
        return carrier;
    }

    /// Bodies may have been put in another order when they were rounded.
    ConstraintVisitor::BodyNode nodeOf(int foundBody) const {
        const auto body = std::ranges::find(_bodies, _found.bodies[foundBody].path, &tss::Body::path);
        if (body == _bodies.end()) return {};
        return _visitor.getBodyNodes()[static_cast<std::size_t>(body - _bodies.begin())];
    }

    osg::Node& _root;
    Scene& _scene;
    const tss::SceneModel& _model;
    ConstraintVisitor _visitor;
    const std::vector<tss::Body>& _bodies; ///< that it has found
    tss::SceneModel _found;                ///< rounded as what was baked is
    std::set<const osg::Drawable*> _shown;
};

} // namespace

void addOutermost(osg::Node& node, osg::Callback& callback) {
    if (osg::Callback* others = node.getUpdateCallback()) callback.addNestedCallback(others);
    node.setUpdateCallback(&callback);
}

void restoreDrawables(osg::Node& root) {
    std::set<osg::ref_ptr<SkinGeometry>> found;
    eachNode(root, [&](osg::Node& node) {
        if (node.asDrawable() && replacedBy(*node.asDrawable()))
            found.insert(static_cast<SkinGeometry*>(node.asDrawable()));
    });
    for (const osg::ref_ptr<SkinGeometry>& shown : found) putBack(root, *shown);
}

/// On the root: skins, and muscles between two bones, are deformed after everything else of the scene has
/// found its place.
void installSkins(osg::Node& root, Scene& scene, Installed& installed) {
    const tss::SceneModel& model = scene.getModel();
    std::unique_ptr<OwnSkins> all, active;
    const auto shapes = model.skins.empty() ? BodyNodes{} : findBodyNodes(root);
    for (const tss::MuscleModel& muscle : model.muscles)
        if (muscle.insertionBone >= 0)
            addOutermost(root, *osg::ref_ptr<MuscleCallback>(new MuscleCallback(&scene, muscle.path)));
    for (std::size_t s = 0; s < model.skins.size(); ++s) {
        const tss::SkinModel& skin = model.skins[s];
        std::string why;
        if (!shapes.shapes.contains(model.bodies[skin.body].path)) {
            if (!all) all = std::make_unique<OwnSkins>(root, scene, false);
            why = all->show(static_cast<int>(s));
            if (!why.empty() && !active) active = std::make_unique<OwnSkins>(root, scene, true);
            if (!why.empty() && active->show(static_cast<int>(s)).empty()) why.clear();
        }
        if (!why.empty()) {
            ++installed.stale;
            OSG_WARN << "osgTSS: skin " << skin.path << " does not play: " << why << std::endl;
            continue;
        }
        if (!skin.table) ++installed.unbaked; // its bones and muscles carry it all the same
        osg::ref_ptr<SkinCallback> callback = new SkinCallback(&scene, skin.path);
        addOutermost(root, *callback);
        ++installed.skins;
    }
}

} // namespace osgTSS
