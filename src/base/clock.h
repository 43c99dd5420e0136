/* Clocks for measuring how long work takes. Only differences of two readings have a meaning. */
#ifndef CORCAST_BASE_CLOCK_H
#define CORCAST_BASE_CLOCK_H

/* Returns the reading, in seconds, of a monotonic clock: it never runs backwards, even if the time
 * of day is changed. */
double clock_seconds(void);
/* Returns the processor time, in seconds, that this process has used in all its threads. */
double clock_cpu_seconds(void);

#endif
