/* Clocks. */
#ifndef CORCAST_BASE_CLOCK_H
#define CORCAST_BASE_CLOCK_H

/* Seconds of a monotonic clock, from any time on. */
double clock_seconds(void);
/* Seconds that processors have spent on this program, all threads together. */
double clock_cpu_seconds(void);

#endif
