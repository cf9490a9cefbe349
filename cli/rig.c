/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie rig: the commands about rig files. */
#include "rig.h"

#include <stdio.h>
#include <string.h>

#include "cli.h"

static const struct {
    const char *name, *summary;
    int (*run)(int argc, char **argv);
} rig_commands[] = {
    {"new", "writes a rig file that explains every key", rig_new},
    {"check", "compares a rig with a recording", rig_check},
    {"calibrate", "measures registration and gains of the planes", rig_calibrate},
};

static int print_overview(void) {
    printf("Rig files: how a set-up is built, written down once.\n\n"
           "  ptie rig new --layout mosaic --mosaic crysta --pixel \"20 um\" -o lab.ini\n"
           "  ptie rig calibrate lab.ini --target target.mraw\n"
           "  ptie rig check lab.ini flow.mraw\n"
           "  ptie run --rig lab.ini flow.mraw --model models/paper.safetensors -o phase.h5\n\n"
           "Commands:\n");
    for (size_t i = 0; i < COUNT(rig_commands); i++)
        printf("  %-13s%s\n", rig_commands[i].name, rig_commands[i].summary);
    printf("\n'ptie rig COMMAND --help' shows examples and options of a command.\n");
    return DONE;
}

int rig_command(int argc, char **argv) {
    const char *names[COUNT(rig_commands) + 1] = {0};
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)
        return print_overview();
    for (size_t i = 0; i < COUNT(rig_commands); i++) {
        names[i] = rig_commands[i].name;
        if (strcmp(argv[1], names[i]) == 0) return rig_commands[i].run(argc - 1, argv + 1);
    }
    return misused("rig: unknown command '%s' (did you mean '%s'?)", argv[1],
                   ptie_nearest_word(argv[1], names));
}
