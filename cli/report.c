/* SPDX-License-Identifier: BSD-3-Clause */
/* ptie report: the result of a run -> one HTML page. */
#include "cli.h"

static const char examples[] =
    "  ptie report phase.h5 -o phase.html\n\n"
    "  # a run that is still going on\n"
    "  ptie report phase.h5.part -o so-far.html -f\n";

static const char notes[] =
    "The page needs no other file: parameters, warnings, phase and denoised phase,\n"
    "metrics over time with mean and standard deviation, averages, and the noise\n"
    "beside what the camera explains. 'ptie run' draws it at its end.\n";

int report_command(int argc, char **argv) {
    const char *output = NULL;
    bool force = false;
    const option options[] = {
        {'o', "output", OPTION_TEXT, &output, "FILE", .help = "page to write (.html)"},
        {'f', "force", OPTION_FLAG, &force, .help = "replace existing output"},
    };
    const command_usage usage = {.name = "report",
                                 .purpose = "Draws what a run did and found as one HTML page.",
                                 .examples = examples,
                                 .synopsis = "RESULT -o FILE.html [options]",
                                 .notes = notes,
                                 .least = 1,
                                 .most = 1,
                                 .operand = "RESULT",
                                 .options = options,
                                 .count = COUNT(options)};
    operand_list operands;
    const int code = parse_options(&usage, argc, argv, &operands);
    if (code != GO_ON) return code;
    if (!output) return misused("report: missing output (expected -o FILE.html)");
    const ptie_status status = ptie_report_write(output, operands.value[0], force);
    return status == PTIE_OK ? DONE : failed(status);
}
