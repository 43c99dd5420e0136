/* The version of the program and the library, as text. */
#ifndef CORCAST_BASE_VERSION_H
#define CORCAST_BASE_VERSION_H

#define CORCAST_VERSION "0.1.0"

#endif
