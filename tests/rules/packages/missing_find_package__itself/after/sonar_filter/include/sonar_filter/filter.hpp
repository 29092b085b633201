#pragma once

double filtered(double value);
