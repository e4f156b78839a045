#pragma once
#include "osgTSS/src/SceneCache.h"
#include "osgTSS/src/draw/BodyNodes.h"

#include <osgTSS/ContactCallback>
#include <osgTSS/Scene>

#include <vector>

namespace osgTSS {

/// What an application is to be told, once nothing else is left to do: it may take all of it away.
class ToldContacts {
public:
    void add(const Contact& contact) { _contacts.push_back({contact, contact.nodeA, contact.nodeB}); }
    void tell(ContactCallback& callback, osg::NodeVisitor& visitor) const {
        for (const Entry& entry : _contacts) callback(entry.contact, visitor);
    }

private:
    struct Entry {
        Contact contact;
        osg::ref_ptr<osg::Node> nodeA, nodeB; ///< so that they are there when it is told
    };
    std::vector<Entry> _contacts;
};

/// The contacts of the joints that one callback resolves below one node.
class ContactReport {
public:
    /// After joints were resolved to q, with these answers, one per group of the plan. What held a joint
    /// touches.
    ToldContacts report(const Scene& scene, SharedPlan& plan, const std::vector<double>& q,
                        const std::vector<tss::GroupAnswer>& answers, osg::NodeVisitor& visitor);

    /// The graph has changed: the bodies' nodes are looked for again.
    void lookAgain() { _unknown = true; }

private:
    /// A pair and what was last told of it.
    struct Watched {
        int pair = -1;
        BodyFrame a, b;
        bool touching = false;
        Contact last;
    };

    static bool watches(const std::vector<Watched>& watched, const tss::JointPlan::Group& group);
    /// Goes on with the pairs of a plan; what touched and is no pair of it any more has ended.
    void watch(const Scene& scene, const tss::JointPlan& plan, osg::NodeVisitor& visitor, ToldContacts& told);
    static void locate(const tss::SceneModel& model, const tss::QueryResult& found, Watched& watched);

    std::vector<std::vector<Watched>> _groups; ///< as the plan's
    bool _unknown = false;                     ///< where the bodies' nodes are by now
};

} // namespace osgTSS
