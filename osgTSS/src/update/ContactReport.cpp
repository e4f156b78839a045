#include "ContactReport.h"

#include "osgTSS/src/NodePaths.h"

#include <osgTSS/Convert>

#include <algorithm>
#include <map>

namespace osgTSS {

bool ContactReport::watches(const std::vector<Watched>& watched, const tss::JointPlan::Group& group) {
    return std::ranges::equal(watched, group.pairs, {}, &Watched::pair);
}

void ContactReport::watch(const Scene& scene, const tss::JointPlan& plan, osg::NodeVisitor& visitor,
                          ToldContacts& told) {
    const tss::SceneModel& model = scene.getModel();
    const osg::NodePath& path = visitor.getNodePath();
    // Bodies may stand above the node of the callback, up to the root that the scene was installed on; of
    // several machines of one kind the nearest is meant.
    std::vector<BodyNodes> nodes;
    for (std::size_t k = path.size(); k-- > 0;) {
        nodes.push_back(findBodyNodes(*path[k]));
        if (Scene::on(*path[k]) == &scene) break;
    }
    const auto side = [&](int body) {
        for (const BodyNodes& below : nodes)
            if (BodyFrame frame = below.frame(model.bodies[body].path); frame.node.valid()) return frame;
        return BodyFrame{};
    };
    _unknown = false;
    std::map<int, Watched> before;
    for (const std::vector<Watched>& group : _groups)
        for (const Watched& watched : group)
            if (watched.touching) before[watched.pair] = watched;
    _groups.clear();
    for (const tss::JointPlan::Group& group : plan.groups) {
        std::vector<Watched> watched;
        for (int pair : group.pairs) {
            Watched one{pair, side(model.pairs[pair].bodyA), side(model.pairs[pair].bodyB), false, {}};
            if (const auto was = before.find(pair); was != before.end()) {
                one.touching = true;
                one.last = was->second.last;
                before.erase(was);
            }
            watched.push_back(std::move(one));
        }
        _groups.push_back(std::move(watched));
    }
    // Pairs that are no longer kept apart.
    for (auto& [pair, watched] : before) {
        watched.last.event = Contact::END;
        watched.last.nodeA = watched.a.node.get();
        watched.last.nodeB = watched.b.node.get();
        told.add(watched.last);
    }
}

void ContactReport::locate(const tss::SceneModel& model, const tss::QueryResult& found, Watched& watched) {
    const tss::Pair& pair = model.pairs[watched.pair];
    Contact& contact = watched.last;
    contact.pairPath = pair.path;
    contact.bodyA = model.bodies[pair.bodyA].path;
    contact.bodyB = model.bodies[pair.bodyB].path;
    contact.nodeA = watched.a.node.get();
    contact.nodeB = watched.b.node.get();
    contact.gap = found.gap;
    osg::Matrixd toWorld = toOsg(model.bodies[pair.bodyA].placement);
    double scale = 1;
    if (contact.nodeA) {
        toWorld = alongPath(contact.nodeA->getParentalNodePaths().front());
        scale = watched.a.scale;
    }
    contact.point = toOsg(found.point) / scale * toWorld;
    // Of the surface still where scales differ between axes: by the inverse, transposed.
    contact.normal = osg::Matrixd::transform3x3(osg::Matrixd::inverse(toWorld), toOsg(found.normal));
    contact.normal.normalize();
}

ToldContacts ContactReport::report(const Scene& scene, SharedPlan& plan, const std::vector<double>& q,
                                   const std::vector<tss::GroupAnswer>& answers, osg::NodeVisitor& visitor) {
    ToldContacts told;
    const tss::SceneModel& model = scene.getModel();
    if (_unknown || !std::ranges::equal(_groups, plan->groups, watches)) watch(scene, *plan, visitor, told);
    for (std::size_t g = 0; g < answers.size(); ++g) {
        const std::vector<int>& held = answers[g].held;
        for (std::size_t k = 0; k < _groups[g].size(); ++k) {
            Watched& watched = _groups[g][k];
            const bool before = watched.touching;
            watched.touching = std::ranges::find(held, static_cast<int>(k)) != held.end();
            if (!watched.touching && !before) continue;
            if (watched.touching)
                locate(model, plan.inRoom([&](auto& room) { return tss::nearest(*plan, g, k, q, room); }),
                       watched);
            watched.last.event = !watched.touching ? Contact::END : before ? Contact::STAY : Contact::BEGIN;
            watched.last.status = answers[g].status;
            told.add(watched.last);
        }
    }
    return told;
}

} // namespace osgTSS
