// The threads of the core behind the C interface.
#include "host/crew.hpp"

void abacus_stop_threads(void) { abacus::Crew::stop_all(); }
