// The words of Qt that its own compiler reads; its classes are stood for like those of any library.
#pragma once
#include "ri_core.hpp"
typedef double qreal;
typedef unsigned int uint;
typedef long long qint64;
#define Q_OBJECT
#define Q_SIGNALS public
#define Q_SLOTS
#define Q_EMIT
#define Q_PROPERTY(...)
#define Q_UNUSED(name) (void)name;
#define signals public
#define slots
#define emit
#define foreach(declaration, range) for (declaration : range)
#define SIGNAL(text) #text
#define SLOT(text) #text
