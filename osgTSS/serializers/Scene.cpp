#include "bake/base/Error.h"

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>
#include <osgTSS/Scene>

// The whole scene, as the text of its .tss file: numbers come back bit for bit, which OSG's own text does not
// promise.

static bool checkModel(const osgTSS::Scene&) {
    return true;
}

static bool readModel(osgDB::InputStream& is, osgTSS::Scene& scene) {
    std::string text;
    is.readWrappedString(text);
    try {
        scene.setText(text);
        return true;
    } catch (const tss::InputError& error) {
        is.throwException(std::string("osgTSS::Scene: ") + error.what());
        return false;
    }
}

static bool writeModel(osgDB::OutputStream& os, const osgTSS::Scene& scene) {
    os.writeWrappedString(scene.getText());
    os << std::endl;
    return true;
}

static bool checkFrameClock(const osgTSS::Scene& scene) {
    return scene.getClock().source == osgTSS::Clock::FRAME_NUMBER;
}

static bool readFrameClock(osgDB::InputStream& is, osgTSS::Scene& scene) {
    bool byFrame = false;
    is >> byFrame;
    osgTSS::Clock clock = scene.getClock();
    clock.source = byFrame ? osgTSS::Clock::FRAME_NUMBER : osgTSS::Clock::SIMULATION_TIME;
    scene.setClock(clock);
    return true;
}

static bool writeFrameClock(osgDB::OutputStream& os, const osgTSS::Scene&) {
    os << true << std::endl;
    return true;
}

REGISTER_OBJECT_WRAPPER(osgTSS_Scene, new osgTSS::Scene, osgTSS::Scene, "osg::Object osgTSS::Scene") {
    ADD_USER_SERIALIZER(Model);
    ADD_USER_SERIALIZER(FrameClock);
}
