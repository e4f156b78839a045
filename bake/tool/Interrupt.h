#pragma once

namespace tss::tool {

/// While it lives, SIGINT and SIGTERM are heard instead of ending the program; the second one ends it.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;

    /// The signal that came; 0: none.
    static int signal();
};

} // namespace tss::tool
