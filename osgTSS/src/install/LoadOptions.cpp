#include "bake/base/Error.h"

#include <osgTSS/LoadOptions>

#include <cstdlib>
#include <sstream>

namespace osgTSS {

namespace {

Clock::Source clockOf(const std::string& name, const std::string& where) {
    if (name == "frame") return Clock::FRAME_NUMBER;
    if (name == "time") return Clock::SIMULATION_TIME;
    throw tss::InputError(where + ": expected frame or time, found \"" + name + "\"");
}

bool onOff(const std::string& value, const std::string& where) {
    if (value == "on") return true;
    if (value == "off") return false;
    throw tss::InputError(where + ": expected on or off, found \"" + value + "\"");
}

} // namespace

LoadOptions::LoadOptions(const std::string& optionString) {
    if (const char* variable = std::getenv("OSGTSS_CLOCK"))
        clock = clockOf(variable, "environment variable OSGTSS_CLOCK");
    std::istringstream words(optionString);
    for (std::string word; words >> word;) {
        const std::size_t equals = word.find('=');
        const std::string key = word.substr(0, equals);
        const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
        if (key == "clock")
            clock = clockOf(value, "option clock");
        else if (key == "light")
            graph.keyLight = onOff(value, "option light");
        else if (key == "noRotation")
            graph.rotateUp = false;
        else if (key == "overlay")
            overlay = equals == std::string::npos || onOff(value, "option overlay");
        else if (key == "play")
            play = equals == std::string::npos || onOff(value, "option play");
        else if (equals != std::string::npos)
            others[key] = value;
    }
}

} // namespace osgTSS
