#include "bake/tool/Interrupt.h"

#include <csignal>

namespace tss::tool {

namespace {

volatile std::sig_atomic_t came = 0;

void hear(int signal) {
    came = signal;
}

void install(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = static_cast<int>(SA_RESETHAND); // the second ends the program
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN)
            sigaction(signal, &action, nullptr); // as nohup and shells' & want it
    }
}

} // namespace

Interrupt::Interrupt() {
    came = 0;
    install(hear);
}

Interrupt::~Interrupt() {
    install(SIG_DFL);
}

int Interrupt::signal() {
    return came;
}

} // namespace tss::tool
