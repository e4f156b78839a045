#include "osgTSS/src/CallbackOf.h"
#include "osgTSS/src/SceneCache.h"
#include "osgTSS/src/UserValues.h"

#include <osg/Stats>
#include <osgGA/EventVisitor>
#include <osgTSS/Overlay>
#include <osgTSS/ViewerCallback>
#include <osgViewer/View>
#include <osgViewer/ViewerBase>
#include <osgViewer/ViewerEventHandlers>

#include <algorithm>

namespace osgTSS {

namespace {

const char* const line = "TSS";
const char* const taken = "TSS time taken";
const char* const begins = "TSS begin time";
const char* const ends = "TSS end time";

/// The line in the viewer's statistics, once a handler: several scenes add up in it.
void addLine(osgViewer::View& view) {
    const osg::Vec4 color(0.4f, 0.9f, 0.7f, 1), bar(0.4f, 0.9f, 0.7f, 0.5f);
    constexpr float milliseconds = 1000, most = 0.016f;
    for (const auto& handler : view.getEventHandlers()) {
        auto* stats = dynamic_cast<osgViewer::StatsHandler*>(handler.get());
        if (!stats || hasFlag(*stats, "osgTSS:line")) continue;
        stats->setUserValue("osgTSS:line", true);
        stats->addUserStatsLine(line, color, bar, taken, milliseconds, true, false, begins, ends, most);
    }
}

/// What the last update traversal took goes to the frame that it belongs to.
void report(osgViewer::View& view, UpdateTime& time) {
    osg::Stats* stats = view.getViewerBase() ? view.getViewerBase()->getViewerStats() : nullptr;
    time.wanted = stats && stats->collectStats("update");
    if (!time.wanted || time.begin == 0 || !view.getFrameStamp()) return;
    const unsigned int frame = view.getFrameStamp()->getFrameNumber() - 1;
    const osg::Timer& clock = *osg::Timer::instance();
    double seconds = 0, first = clock.delta_s(view.getStartTick(), time.begin), other = 0;
    if (stats->getAttribute(frame, taken, other)) seconds = other;
    if (stats->getAttribute(frame, begins, other)) first = std::min(first, other);
    stats->setAttribute(frame, taken, seconds + time.seconds);
    stats->setAttribute(frame, begins, first);
    stats->setAttribute(frame, ends, clock.delta_s(view.getStartTick(), time.end));
    time.reset();
}

} // namespace

ViewerCallback::ViewerCallback(const ViewerCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), SceneCallback(other, copyop) {}

bool ViewerCallback::run(osg::Object* object, osg::Object* data) {
    osg::Node* node = object ? object->asNode() : nullptr;
    auto* visitor = dynamic_cast<osgGA::EventVisitor*>(data);
    if (node && visitor && _scene) {
        osgGA::GUIActionAdapter* adapter = visitor->getActionAdapter();
        if (auto* view = adapter ? dynamic_cast<osgViewer::View*>(adapter->asView()) : nullptr) {
            addLine(*view);
            report(*view, _scene->getCache().updateTime);
        }
        for (const auto& event : visitor->getEvents()) {
            const osgGA::GUIEventAdapter* key = event->asGUIEventAdapter();
            if (!key || key->getHandled() || key->getEventType() != osgGA::GUIEventAdapter::KEYDOWN ||
                key->getKey() != 'x')
                continue;
            if (Overlay* overlay = Overlay::find(*node)) overlay->setShown(!overlay->getShown());
        }
    }
    return traverse(object, data);
}

void addViewerAids(osg::Group& root, Scene& scene, bool overlayShown) {
    osg::ref_ptr<Overlay> overlay = Overlay::find(root);
    if (!overlay) {
        overlay = new Overlay(&scene);
        root.addChild(overlay);
    }
    overlay->setShown(overlayShown);
    if (!callbackOf<ViewerCallback>(root.getEventCallback()))
        root.addEventCallback(new ViewerCallback(&scene));
}

} // namespace osgTSS
