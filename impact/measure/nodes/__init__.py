"""The nodes that are run: publishers and subscribers of roscpp, rospy and DDS, with one protocol for the runner.

A node prints lines that begin with `measure:`. A publisher prints `ready` once a subscriber is connected, waits for
`start TIME` on its standard input, publishes on schedule and prints its report as JSON. A subscriber prints `ready`,
and after `end` writes what it saw once nothing arrives any more. Both end when their standard input does, so that none
outlives the runner.

What a subscriber saw is a file of records of five 64-bit integers: 0 for an arrival or 1 for a callback, the publisher,
the number of the message, when it was published and when this happened, in nanoseconds. An arrival is seen before the
subscriber's queue, a callback behind it: what is published and does not arrive was dropped by the publisher's queue,
what arrives and gets no callback by that of the subscriber.
"""
