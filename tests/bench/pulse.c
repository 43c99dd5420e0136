/* Times the parts of `pulse` on a tree, in seconds of all threads together and of the wall clock.
 */
#include "pulse/pulse.h"

#include "treeio/treeio.h"
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

static const TreeMeta no_options;

static double processor_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static void print(const char *what, double processor, double wall)
{
    printf("%-24s %6.2f s of processor %6.2f s\n", what, processor_seconds() - processor,
           clock_seconds() - wall);
}

int main(int argc, char **argv)
{
    Tree tree = {0};
    Err err;
    Waveform drive = {.period_s = 0.8, .mean = 1, .harmonics = 16};
    Pulse pulse;
    PulseMeasures *cycles;
    const int threads = argc > 2 ? atoi(argv[2]) : 2;
    if (argc < 2 || tree_read(&tree, argv[1], &err) != STATUS_OK)
        return 2;
    for (int k = 1; k <= 16; k++)
        drive.re[k] = 0.1 / k;
    PulseParams params = {.tree = &tree,
                          .overrides = &no_options,
                          .harmonics = 16,
                          .drive = &drive,
                          .outlet_time_s = 1,
                          .threads = threads};
    if (!pulse_wall_parse("olufsen", &params.wall))
        return 2;
    double processor = processor_seconds(), wall = clock_seconds();
    if (pulse_solve(&params, &pulse, &err) != STATUS_OK) {
        fprintf(stderr, "%s\n", err.text);
        return 2;
    }
    print("waves, 16 harmonics", processor, wall);
    processor = processor_seconds(), wall = clock_seconds();
    if (pulse_measure(&pulse, threads, &cycles, &err) != STATUS_OK)
        return 2;
    print("cycles, 64 samples", processor, wall);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    printf("%zu nodes, %ld MB\n", tree.n, usage.ru_maxrss / 1024);
    free(cycles);
    pulse_release(&pulse);
    tree_release(&tree);
    return 0;
}
