#include "gait_library/gait.hpp"

double plan() { return gait_library::period(2.0); }
