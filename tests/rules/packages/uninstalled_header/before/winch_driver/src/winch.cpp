#include "winch_driver/winch.h"

double winch_driver::length(const Drum & drum) { return drum.radius * drum.angle; }
