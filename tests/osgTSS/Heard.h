#pragma once
#include <osg/Notify>
#include <osg/ref_ptr>

#include <string>

/// What is said while it lives.
class Heard {
public:
    Heard() : _handler(new Handler), _before(osg::getNotifyHandler()) { osg::setNotifyHandler(_handler); }
    ~Heard() { osg::setNotifyHandler(_before); }
    Heard(const Heard&) = delete;
    Heard& operator=(const Heard&) = delete;

    /// How often.
    std::size_t times(const std::string& words) const {
        std::size_t count = 0;
        for (std::size_t at = 0; (at = _handler->text.find(words, at)) != std::string::npos; ++at) ++count;
        return count;
    }

private:
    struct Handler : osg::NotifyHandler {
        void notify(osg::NotifySeverity, const char* message) override { text += message; }
        std::string text;
    };
    osg::ref_ptr<Handler> _handler;
    osg::ref_ptr<osg::NotifyHandler> _before;
};
