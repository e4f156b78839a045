#include <osg/Notify>
#include <osgTSS/LoadOptions>

#include <cstdlib>
#include <sstream>

namespace osgTSS {

namespace {

/// Sets what a word stands for; a value that is none of its two stays unset, and is told.
template <class Setting>
void setTo(Setting& setting, const std::string& value, const std::string& where, const char* first,
           Setting ofFirst, const char* second, Setting ofSecond) {
    if (value == first)
        setting = ofFirst;
    else if (value == second)
        setting = ofSecond;
    else
        OSG_WARN << "osgTSS: " << where << ": expected " << first << " or " << second << ", found \"" << value
                 << "\"; it is passed over" << std::endl;
}

} // namespace

LoadOptions::LoadOptions(const std::string& optionString) {
    const auto setClock = [&](const std::string& value, const std::string& where) {
        setTo(clock, value, where, "frame", Clock::FRAME_NUMBER, "time", Clock::SIMULATION_TIME);
    };
    const auto setFlag = [](bool& flag, const std::string& key, const std::string& value) {
        setTo(flag, value, "option " + key, "on", true, "off", false);
    };
    if (const char* variable = std::getenv("OSGTSS_CLOCK"))
        setClock(variable, "environment variable OSGTSS_CLOCK");
    std::istringstream words(optionString);
    for (std::string word; words >> word;) {
        const std::size_t equals = word.find('=');
        const std::string key = word.substr(0, equals);
        const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
        if (key == "clock")
            setClock(value, "option clock");
        else if (key == "light")
            setFlag(graph.keyLight, key, value);
        else if (key == "noRotation")
            graph.rotateUp = false;
        else if (key == "overlay" || key == "play")
            setFlag(key == "overlay" ? overlay : play, key, equals == std::string::npos ? "on" : value);
        else if (equals != std::string::npos)
            others[key] = value;
    }
}

} // namespace osgTSS
