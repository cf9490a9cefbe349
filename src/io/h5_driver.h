/* SPDX-License-Identifier: BSD-3-Clause */
/* How HDF5 writes: a driver that remembers the first failed write instead of returning it.
 * HDF5 1.10 cannot close a file or data set that it cannot write out; it tries again at exit and
 * crashes.  With this driver it always closes, and the failure is reported by ours.
 */
#ifndef PTIE_IO_H5_DRIVER_H
#define PTIE_IO_H5_DRIVER_H

#include <hdf5.h>

/* Makes files of the access list use the driver.  *failure is the errno of the first failed write;
   it must outlive the file. */
herr_t ptie_h5_use_driver(hid_t access, int *failure);

#endif
